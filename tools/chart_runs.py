"""Runs of scenes for charts: what a run cost, and how far it was from the references of its scene."""

import json
import os
import subprocess
from pathlib import Path

import run_record

RUNS = Path(__file__).resolve().parent.parent / "runs"
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")


def run_program(arguments, program=RUNS.parent / "build" / "release" / "talus"):
    """The finished process of the program on one rank."""
    return subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, stdin=subprocess.DEVNULL,
                          env=ENVIRONMENT)


def performance_of(out):
    return json.loads((Path(out) / "performance.json").read_text())


def run_scene(program, folder, scene, settings=(), until=None):
    """Runs runs/`scene` with settings "key=value" on one rank. Returns a row: work (pairs, the same on any machine), particles,
    steps, seconds of the steps, `errors` {name of the reference: relative error} and `uncertainties` {name: the reference's own}; a run
    that fails says so in `failed`."""
    out = Path(folder) / f"run_{len(list(Path(folder).iterdir()))}"
    line = ["run", RUNS / scene, "--out", out]
    for setting in settings:
        line += ["--set", setting]
    if until is not None:
        line += ["--until", until]
    done = run_program(line, program)
    if done.returncode != 0:
        return {"failed": (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[0]}
    performance = performance_of(out)
    compared = [c for c in run_record.compare(out, run_record.read_state(out)[0]) if c.found is not None and c.value]
    return {"pairs": performance["pairs"], "particles": performance["particles"], "steps": performance["steps"],
            "seconds": performance["seconds"],
            "errors": {c.name: abs(c.found / c.value - 1) for c in compared},
            "uncertainties": {c.name: abs(c.uncertainty / c.value) for c in compared}}
