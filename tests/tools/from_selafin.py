"""tools/terrain/from_selafin.py on a mesh of two triangles."""
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "terrain" / "from_selafin.py"


def record(content):
    return struct.pack(">i", len(content)) + content + struct.pack(">i", len(content))


def integers(*values):
    return record(struct.pack(f">{len(values)}i", *values))


def reals(*values):
    return record(struct.pack(f">{len(values)}f", *values))


def mesh(name=b"BOTTOM"):
    """A square of 10 m with the bottom z = x + 2 y, without its north-western half."""
    return (record(b"test".ljust(80)) + integers(1, 0) + record(name.ljust(16) + b"M".ljust(16))
            + integers(1, *[0] * 9) + integers(2, 4, 3, 1) + integers(1, 2, 3, 2, 4, 3) + integers(1, 2, 3, 4)
            + reals(0, 10, 10, 20) + reals(0, 0, 10, 0) + reals(0) + reals(0, 10, 30, 20))


class FromSelafin(unittest.TestCase):
    def run_tool(self, content, *options):
        with tempfile.TemporaryDirectory() as folder:
            source, out = Path(folder) / "mesh.slf", Path(folder) / "out.asc"
            source.write_bytes(content)
            done = subprocess.run([sys.executable, "-B", TOOL, source, out, *options], capture_output=True, text=True)
            return done, out.read_text().split("\n") if out.exists() else None

    def test_the_bottom_is_linear_between_nodes(self):
        done, lines = self.run_tool(mesh(), "--cell", "2", "--outside", "99")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(lines[:6], ["ncols 10", "nrows 5", "xllcorner 0.000000", "yllcorner 0.000000", "cellsize 2",
                                     "NODATA_value -9999"])
        south, north = [list(map(float, lines[k].split())) for k in (10, 6)]
        self.assertEqual(south[2], 5 + 2 * 1)
        self.assertEqual(north[0], 99)

    def test_files_that_are_no_meshes_are_refused(self):
        done, lines = self.run_tool(mesh()[:200])
        self.assertIn("no Serafin file, or is cut off", done.stderr)
        self.assertIsNone(lines)
        done, _ = self.run_tool(mesh(b"FROUDE"))
        self.assertIn("has no bottom, only FROUDE", done.stderr)


if __name__ == "__main__":
    unittest.main()
