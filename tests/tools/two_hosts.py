#!/usr/bin/python3
"""Two hosts: ranks in two network name spaces that see each other by TCP alone give the bits of one rank. Needs root and
iproute2; skipped with a message where name spaces are not allowed. Usage: two_hosts.py TALUS MPIRUN."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
TALUS, MPIRUN = sys.argv.pop(1), sys.argv.pop(1)
SCENE = TOP / "runs" / "basalt_impact"
NET = "10.99.0.0/24"
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")


def command(*line):
    return subprocess.run([str(word) for word in line], capture_output=True, text=True, stdin=subprocess.DEVNULL, env=ENVIRONMENT,
                          timeout=120)


def make_hosts(names):
    """The first fault in words, or None."""
    first, second = names
    steps = [["ip", "netns", "add", name] for name in names]
    steps += [["ip", "link", "add", f"{first}_v", "type", "veth", "peer", "name", f"{second}_v"]]
    for number, name in enumerate(names, 1):
        steps += [["ip", "link", "set", f"{name}_v", "netns", name],
                  ["ip", "netns", "exec", name, "ip", "addr", "add", f"10.99.0.{number}/24", "dev", f"{name}_v"],
                  ["ip", "netns", "exec", name, "ip", "link", "set", "lo", "up"],
                  ["ip", "netns", "exec", name, "ip", "link", "set", f"{name}_v", "up"]]
    for step in steps:
        try:
            done = command(*step)
        except OSError as failure:
            return str(failure)
        if done.returncode != 0:
            return f"{' '.join(step)}: {done.stderr.strip()}"
    return None


class TwoHosts(unittest.TestCase):
    def setUp(self):
        self.names = [f"tal{os.getpid() % 100000}{letter}" for letter in "ab"]
        for name in self.names:
            self.addCleanup(command, "ip", "netns", "del", name)
        if fault := make_hosts(self.names):
            self.skipTest(f"no network name spaces here ({fault})")
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def test_the_same_bits_as_on_one(self):
        agent = self.folder / "agent"  # stands for ssh
        agent.write_text(f'#!/bin/sh\nshift\nexec ip netns exec {self.names[1]} sh -c "$*"\n')
        agent.chmod(0o755)
        done = command("ip", "netns", "exec", self.names[0], MPIRUN, "--mca", "plm_rsh_agent", agent, "--mca", "oob_tcp_if_include",
                       NET, "--mca", "btl_tcp_if_include", NET, "--mca", "btl", "tcp,self", "--mca", "pml", "ob1", "--host",
                       "10.99.0.1:1,10.99.0.2:1", "-n", "2", TALUS, "run", SCENE, "--quick", "--steps", "10", "--out",
                       self.folder / "two")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(command(TALUS, "run", SCENE, "--quick", "--steps", "10", "--out", self.folder / "one").returncode, 0)
        hashes = [command(TALUS, "hash", self.folder / name).stdout for name in ("one", "two")]
        self.assertTrue(hashes[0])
        self.assertEqual(*hashes)


if __name__ == "__main__":
    unittest.main()
