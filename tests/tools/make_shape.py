"""tools/make_shape: closed surfaces, the one of runs/bilobed_impact among them."""
import collections
import math
import pathlib
import subprocess
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]


def made(*options):
    return subprocess.run([TOP / "tools" / "make_shape", *options], capture_output=True, text=True, check=True).stdout


def parsed(text):
    lines = [line.split() for line in text.splitlines()]
    return ([tuple(map(float, line[1:])) for line in lines if line[0] == "v"],
            [tuple(int(k) - 1 for k in line[1:]) for line in lines if line[0] == "f"])


def volume(vertices, faces):
    def determinant(a, b, c):
        return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return sum(determinant(*(vertices[k] for k in face)) for face in faces) / 6


class MakeShape(unittest.TestCase):
    def test_the_shape_of_the_scene_is_what_the_tool_makes(self):
        self.assertEqual(made("bilobed"), (TOP / "runs" / "bilobed_impact" / "bilobed.obj").read_text())

    def test_surfaces_are_closed_and_seen_from_outside(self):
        for options in (["sphere"], ["bilobed", "--cuts", "2", "--ratio", "0.5"]):
            vertices, faces = parsed(made(*options))
            edges = collections.Counter((f[k], f[(k + 1) % 3]) for f in faces for k in range(3))
            self.assertTrue(all(edges[(b, a)] == count == 1 for (a, b), count in list(edges.items())))
            self.assertGreater(volume(vertices, faces), 0)

    def test_a_fine_sphere_has_the_volume_of_a_ball(self):
        # Faces lie inside the ball by a share of the order of a quarter of the square of an edge, 0.07 here.
        self.assertAlmostEqual(volume(*parsed(made("sphere", "--cuts", "4"))) / (4 / 3 * math.pi), 1, delta=0.004)


if __name__ == "__main__":
    unittest.main()
