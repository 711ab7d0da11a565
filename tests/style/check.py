#!/usr/bin/python3
"""Rules of the sources that a compiler does not hold: the include arrows, sizes, leftovers, scene folders.

usage: check.py [TOP_FOLDER]
"""

import re
import sys
import tomllib
import unittest
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]

MAY_INCLUDE = {  # folder -> folders of ours it may include
    "domain": {"domain"},
    "comm": {"comm", "domain"},
    "physics": {"physics", "domain", "comm"},
    "io": {"io", "domain", "comm"},
    "src": {"src", "domain", "comm", "physics", "io"},
}
ONLY_IN = {"mpi.h": {"comm", "io"}, "hdf5.h": {"io"}, "hdf5_hl.h": {"io"}, "gdal_priv.h": {"io"}, "ogrsf_frmts.h": {"io"}}
LONGEST = 500  # lines
LEFTOVERS = re.compile(r"\b(?:TO" + r"DO|FIX" + r"ME|X" + r"XX)\b")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SOURCE_FOLDERS = [*MAY_INCLUDE, "tests", "tools", "runs", "docs", ".ci"]
SOURCE_SUFFIXES = {".cpp", ".hpp", ".py", ".sh", ".txt", ".toml", ".md", ".cmake", ""}
CODE_SUFFIXES = {".cpp", ".hpp", ".py", ".sh", ".cmake"}


def text_files():
    for folder in SOURCE_FOLDERS:
        for path in sorted((TOP / folder).rglob("*")):
            if path.is_file() and path.suffix in SOURCE_SUFFIXES and "__pycache__" not in path.parts:
                yield path
    yield from (p for p in sorted(TOP.glob("*")) if p.suffix in {".txt", ".md", ".json"})


def is_code(path):
    script = not path.suffix and path.read_bytes()[:2] == b"#!"
    return script or path.suffix in CODE_SUFFIXES or path.name == "CMakeLists.txt"


def lines(path):
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def forbidden_include(path, bracket, target):
    """Why `path` (relative to the top) may not include `target`, or None."""
    folder = path.parts[0]
    first = Path(target).parts[0]
    if target in ONLY_IN and folder in MAY_INCLUDE and folder not in ONLY_IN[target]:
        return f"{target} belongs in {' and '.join(sorted(ONLY_IN[target]))} only"
    if folder not in MAY_INCLUDE or (bracket == "<" and first not in MAY_INCLUDE):
        return None
    if first not in MAY_INCLUDE:
        return "our headers are included by their path from the top folder"
    if first not in MAY_INCLUDE[folder]:
        return f"{folder} may include only {', '.join(sorted(MAY_INCLUDE[folder]))}"
    return None


class Style(unittest.TestCase):
    maxDiff = None

    def assert_none(self, complaints):
        self.assertFalse(complaints, "\n" + "\n".join(complaints))

    def test_rules_catch_what_they_forbid(self):
        self.assertIsNotNone(forbidden_include(Path("domain/a.hpp"), '"', "comm/halo.hpp"))
        self.assertIsNotNone(forbidden_include(Path("physics/sph/a.hpp"), '"', "io/scene.hpp"))
        self.assertIsNotNone(forbidden_include(Path("io/a.cpp"), '"', "physics/sph/kernel.hpp"))
        self.assertIsNotNone(forbidden_include(Path("physics/a.cpp"), "<", "mpi.h"))
        self.assertIsNotNone(forbidden_include(Path("comm/a.cpp"), "<", "hdf5.h"))
        self.assertIsNotNone(forbidden_include(Path("src/a.cpp"), '"', "simulation.hpp"))
        self.assertIsNone(forbidden_include(Path("src/a.cpp"), '"', "physics/sph/kernel.hpp"))
        self.assertIsNone(forbidden_include(Path("io/a.cpp"), "<", "mpi.h"))
        self.assertIsNone(forbidden_include(Path("tests/mpi/a.cpp"), "<", "mpi.h"))

    def test_includes_point_one_way(self):
        complaints = []
        for path in text_files():
            if path.suffix not in {".cpp", ".hpp"}:
                continue
            where = path.relative_to(TOP)
            for number, line in enumerate(lines(path), 1):
                if found := INCLUDE.match(line):
                    if why := forbidden_include(where, found[1], found[2]):
                        complaints.append(f"{where}:{number}: {line.strip()} ({why})")
        self.assert_none(complaints)

    def test_headers_are_guarded(self):
        self.assert_none([
            f"{p.relative_to(TOP)}: no #pragma once"
            for p in text_files()
            if p.suffix == ".hpp" and "#pragma once" not in p.read_text(encoding="utf-8")
        ])

    def test_files_are_short(self):
        self.assert_none([
            f"{p.relative_to(TOP)}: {len(lines(p))} lines (at most {LONGEST}), split it"
            for p in text_files()
            if is_code(p) and len(lines(p)) > LONGEST
        ])

    def test_nothing_is_left_over(self):
        self.assert_none([
            f"{p.relative_to(TOP)}:{number}: {line.strip()}"
            for p in text_files()
            for number, line in enumerate(lines(p), 1)
            if LEFTOVERS.search(line)
        ])

    def test_runs_are_complete(self):
        complaints = []
        for scene in sorted(TOP.glob("runs/*/scene.toml")):
            where = scene.parent.relative_to(TOP)
            if not (scene.parent / "README.md").is_file():
                complaints.append(f"{where}: no README.md")
            try:
                content = tomllib.loads(scene.read_text(encoding="utf-8"))
            except tomllib.TOMLDecodeError as error:
                complaints.append(f"{where}/scene.toml: {error}")
                continue
            if not isinstance(content.get("quick"), dict):
                complaints.append(f"{where}/scene.toml: no [quick] table")
        self.assert_none(complaints)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        TOP = Path(sys.argv.pop(1)).resolve()
    unittest.main()
