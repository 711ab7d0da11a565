#!/usr/bin/python3
"""tools/slurm/talus.sbatch under a queue that is imitated: time limits by signal, requeueing by a `scontrol` of our own. Usage:
slurm.py TALUS MPIRUN."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
TALUS, MPIRUN = sys.argv.pop(1), sys.argv.pop(1)
SCENE = TOP / "runs" / "basalt_impact"
STEPS = 150


class Slurm(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.out = self.folder / "out"
        (self.folder / "scontrol").write_text(f'#!/bin/sh\necho "$@" >> {self.folder}/requeued\n')
        (self.folder / "scontrol").chmod(0o755)
        self.environment = dict(os.environ, PATH=f"{self.folder}:{os.environ['PATH']}", SLURM_JOB_ID="7", TALUS=TALUS,
                                TALUS_LAUNCH=f"{MPIRUN} --oversubscribe -n 2", OMPI_ALLOW_RUN_AS_ROOT="1",
                                OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1", OMP_NUM_THREADS="1")

    def requeued(self):
        file = self.folder / "requeued"
        return file.read_text().splitlines() if file.exists() else []

    def job(self, *options, limit=None, kind=signal.SIGUSR1):
        """Code of one job, which gets the signal once it has written a checkpoint of its own and gone on for `limit` seconds."""
        before = set(self.out.glob("checkpoint_*.h5"))
        job = subprocess.Popen(["bash", TOP / "tools" / "slurm" / "talus.sbatch", SCENE, self.out, "--quick", "--steps", str(STEPS),
                                *options], env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
        if limit is not None:
            deadline = time.time() + 60
            while job.poll() is None and time.time() < deadline and not (before or set(self.out.glob("checkpoint_*.h5")) - before):
                time.sleep(0.02)
            time.sleep(limit)
            job.send_signal(kind)
        output, _ = job.communicate(timeout=120)
        return job.returncode, output

    def hash(self, out):
        return subprocess.run([TALUS, "hash", out], check=True, capture_output=True, text=True, env=self.environment).stdout

    def test_a_chain_of_jobs_ends_as_one_run_does(self):
        straight = self.folder / "straight"
        subprocess.run([TALUS, "run", SCENE, "--quick", "--steps", str(STEPS), "--out", straight], check=True, capture_output=True,
                       env=self.environment, stdin=subprocess.DEVNULL)
        code, output = self.job(limit=0)
        self.assertEqual((code, self.requeued()), (0, ["requeue 7"]), output)  # the code of scontrol
        self.assertRegex(output, r"stopped early: signal SIGUSR1")
        code, output = self.job()
        self.assertEqual((code, len(self.requeued())), (0, 1), output)
        self.assertRegex(output, r"going on from .*checkpoint_\d+\.h5")
        self.assertEqual(self.hash(self.out), self.hash(straight))

    def test_a_machine_that_is_taken_back(self):
        code, output = self.job(limit=0, kind=signal.SIGTERM)
        self.assertEqual((code, self.requeued()), (0, ["requeue 7"]), output)

    def test_a_run_that_is_stopped_by_hand_ends_the_chain(self):
        self.out.mkdir()
        (self.out / "stop").touch()
        code, output = self.job()
        self.assertEqual((code, self.requeued()), (75, []), output)
        self.assertIn("file 'stop'", output)

    def test_a_run_that_fails_ends_the_chain(self):
        code, output = self.job("--set", "materials.basalt.densty=1")
        self.assertEqual((code, self.requeued()), (2, []), output)
        self.assertTrue(re.search("densty", output))


if __name__ == "__main__":
    unittest.main()
