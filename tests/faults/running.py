"""Running the program under mpirun, for the tests of this folder.

usage of each: TEST.py PROGRAM MPIRUN RUNS_FOLDER [-k PATTERN]
Exit codes: 0 done, 1 run-time failure, 2 bad scene or usage, 3 input/output, 75 stopped early with a checkpoint.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, MPIRUN, RUNS = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
SCENE = RUNS / "basalt_impact"
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OMPI_MCA_mpi_yield_when_idle="1", OMP_NUM_THREADS="1")


def command(arguments, ranks):
    line = [PROGRAM] if ranks == 0 else [MPIRUN, "--oversubscribe", "-n", str(ranks), PROGRAM]
    return line + [str(a) for a in arguments]


def talus(*arguments, ranks=2, cwd=None):
    return subprocess.run(command(arguments, ranks), capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env=ENVIRONMENT, timeout=240, cwd=cwd)


class Case(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.folder = pathlib.Path(self.holder.name)
        self.out = self.folder / "out"

    def scene(self, text, name="scene.toml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def assert_fails(self, done, code, *patterns):
        output = done.stdout + done.stderr
        self.assertEqual(done.returncode, code, output)
        for pattern in patterns:
            self.assertRegex(output, pattern)

    def hash(self, out):
        done = talus("hash", out, ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done.stdout.split()[0]
