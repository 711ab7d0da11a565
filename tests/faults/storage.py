#!/usr/bin/python3
"""Full disks, power cuts and lost ranks: the run ends with a message and a code, and a checkpoint is left to go on from.

usage: storage.py PROGRAM MPIRUN RUNS_FOLDER FAILING_WRITES_LIBRARY [-k PATTERN]
"""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time
import unittest

LIBRARY = sys.argv.pop(4)
from running import ENVIRONMENT, RUNS, Case, command, talus  # noqa: E402

SCENE = RUNS / "sod_tube"
FIRST, LAST = 3, 6  # steps of the checkpoint that is there, and of the one that fails
MOST = 7            # calls tried of each kind


class Writes(Case):
    """From a run of FIRST steps on, the checkpoint after LAST steps fails at one of the calls that write it."""

    def setUp(self):
        super().setUp()
        self.begun = self.folder / "begun"
        self.go_on(0, self.begun, FIRST)
        straight = self.folder / "straight"
        self.go_on(0, straight, LAST)
        self.expected = self.hash(straight)

    def go_on(self, code, out, steps, *options, **faults):
        line = command(["run", SCENE, "--quick", "--steps", steps, "--out", out, *options], 2)
        for name, value in (faults | {"LD_PRELOAD": LIBRARY} if faults else {}).items():
            line[4:4] = ["-x", f"{name}={value}"]
        done = subprocess.run(line, capture_output=True, text=True, stdin=subprocess.DEVNULL, env=ENVIRONMENT, timeout=60)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def calls(self, path):
        """Calls that write such files in the run from FIRST to LAST, of the rank with the most."""
        shutil.copytree(self.begun, self.out)
        self.go_on(0, self.out, LAST, "--restart", "latest", FAULT_PATH=path, FAULT_KIND="count",
                   FAULT_COUNT=self.folder / "count")
        self.assertEqual(self.hash(self.out), self.expected)
        count = max(int(file.read_text()) for file in self.folder.glob("count.*"))
        self.assertGreater(count, 3)
        return count

    def each(self, path, kind):
        """(call, what became of the run) for calls spread over those of the checkpoint, the first and the last among them."""
        count = self.calls(path)
        for call in sorted({1 + round(k * (count - 1) / (MOST - 1)) for k in range(MOST)}):
            shutil.rmtree(self.out)
            shutil.copytree(self.begun, self.out)
            yield call, self.go_on(None, self.out, LAST, "--restart", "latest", FAULT_PATH=path, FAULT_KIND=kind, FAULT_AT=call)

    def goes_on(self, call):
        """Whatever is the newest checkpoint is whole, and the run goes on from it to the same bits."""
        done = talus("info", self.out, ranks=0)
        self.assertEqual(done.returncode, 0, f"call {call}: {done.stdout}{done.stderr}")
        done = talus("run", SCENE, "--quick", "--steps", LAST, "--out", self.out, "--restart", "latest", ranks=0)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(self.hash(self.out), self.expected, f"call {call}")

    def test_a_power_cut_at_any_write_of_a_checkpoint(self):
        for call, done in self.each("checkpoint_", "kill"):
            self.assertNotEqual(done.returncode, 0, f"call {call}")
            self.goes_on(call)

    def test_a_disk_that_fills_up_at_any_write_of_a_checkpoint(self):
        for call, done in self.each("checkpoint_", "full"):
            self.assert_fails(done, 3, r"checkpoint_\d+\.h5.*No space left")
            self.goes_on(call)

    def test_a_disk_that_fills_up_at_a_table(self):
        for call, done in self.each("diagnostics.csv", "full"):
            self.assert_fails(done, 3, r"diagnostics\.csv")
            self.goes_on(call)


class Storage(Case):
    def test_a_small_disk(self):
        """A file system of 200 KiB in a name space of its own, where that is allowed."""
        self.out.mkdir()
        inside = f"mount -t tmpfs -o size=200k none {self.out} && exec \"$@\""
        line = ["unshare", "--map-root-user", "--mount", "sh", "-c", inside, "sh"]
        if subprocess.run([*line, "true"], capture_output=True).returncode != 0:
            self.skipTest("no name space for a file system here: a disk that fills up is imitated by Writes alone")
        done = subprocess.run([*line, *command(["run", SCENE, "--out", self.out, "--set", "body[0].particles=3200", "--set",
                                                "body[1].particles=400"], 2)],
                              capture_output=True, text=True, stdin=subprocess.DEVNULL, env=ENVIRONMENT, timeout=60)
        self.assert_fails(done, 3, "no space: needs")

    def test_a_folder_that_cannot_be_made(self):
        self.assert_fails(talus("run", SCENE, "--quick", "--out", "/proc/talus/out"), 3, "/proc/talus")


class LostRanks(Case):
    def start(self):
        process = subprocess.Popen(command(["run", SCENE, "--out", self.out, "--until", "100", "--set",
                                            "output.checkpoints=0.5"], 2), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, env=ENVIRONMENT, text=True)
        self.addCleanup(process.kill)
        deadline = time.time() + 60
        while len(list(self.out.glob("checkpoint_*.h5"))) < 2 and time.time() < deadline:
            time.sleep(0.05)
        return process

    def ranks_of(self, process):
        """Process ids of the program under mpirun."""
        found = []
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                parent = int(re.search(r"PPid:\s+(\d+)", (folder / "status").read_text()).group(1))
            except (OSError, AttributeError):
                continue
            if parent == process.pid:
                found.append(int(folder.name))
        return found

    def ends(self, process):
        began = time.time()
        output, _ = process.communicate(timeout=60)
        self.assertNotEqual(process.returncode, 0, output)
        self.assertLess(time.time() - began, 30)
        self.assertEqual(talus("info", self.out, ranks=0).returncode, 0)
        step = int(re.search(r"step +(\d+)", talus("info", self.out, ranks=0).stdout).group(1))
        done = talus("run", SCENE, "--out", self.out, "--restart", "latest", "--steps", step + 2, ranks=1)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_a_rank_that_dies_ends_them_all(self):
        process = self.start()
        os.kill(self.ranks_of(process)[-1], signal.SIGKILL)
        self.ends(process)

    def test_a_terminated_run_leaves_its_last_checkpoint(self):
        process = self.start()
        process.send_signal(signal.SIGTERM)
        self.ends(process)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
