#!/usr/bin/python3
"""tools/report on a run of the program: what the page says, and how Chromium shows it. Usage: report.py TALUS."""

import base64
import html.parser
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
TALUS = sys.argv.pop(1)
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
# Water at rest behind a dam that vanishes: the front of A. Ritter (1892) moves at 2 sqrt(g H); volume stays.
SCENE = """title = "Dam <break> & front"
dimension = 1
[box]
boundaries = ["reflecting"]
lower = [-20]
upper = [20]
[depth]
form = "cartesian"
[[release]]
name = "reservoir"
shape = "box"
lower = [-20]
upper = [0]
depth = 1
particles = 100
[run]
end_time = 1
[output]
snapshots = 0.5
[[reference]]
name = "volume"
figure = "volume"
value = 20
source = "conserved"
[[reference]]
name = "front"
figure = "greatest_x"
time = "0.5 s"
value = 3.1321
uncertainty = 0.01
source = "Ritter 1892: 2 sqrt(g H) t"
[[reference]]
name = "later"
figure = "greatest_x"
time = "9 s"
value = 50
source = "beyond the end"
[[reference]]
name = "ranks used"
file = "performance.json"
figure = "ranks"
value = 4
source = "one was used"
"""


class Page(html.parser.HTMLParser):
    """Cells of the tables, headings and what a page loads."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.headings, self.loads, self.open = [], [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        if tag == "tr":
            self.rows.append([])
        self.open = tag if tag in ("td", "th", "h1", "h2") else self.open
        if self.open in ("td", "th") and tag == self.open:
            self.rows[-1].append("")
        if tag in ("h1", "h2"):
            self.headings.append("")
        self.loads += [value for name, value in attributes if name in ("src", "href")]

    def handle_endtag(self, tag):
        self.open = None if tag == self.open else self.open

    def handle_data(self, data):
        if self.open in ("td", "th"):
            self.rows[-1][-1] += data
        elif self.open:
            self.headings[-1] += data


def show(page, folder):
    """(the document as Chromium has it after loading, lines of its console)."""
    line = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--enable-logging=stderr",
            f"--user-data-dir={folder}/profile", "--virtual-time-budget=20000", "--dump-dom", page.as_uri()]
    done = subprocess.run(line, capture_output=True, text=True, timeout=240, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise AssertionError(f"chromium ended with {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout, [text for text in done.stderr.splitlines() if ":CONSOLE" in text]


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        (cls.folder / "scene.toml").write_text(SCENE)
        cls.out = cls.folder / "out"
        subprocess.run([TALUS, "run", cls.folder / "scene.toml", "--out", cls.out], check=True, capture_output=True,
                       stdin=subprocess.DEVNULL, env=ENVIRONMENT)
        cls.file = cls.report()
        cls.text = cls.file.read_text()
        cls.page = Page(cls.text)

    @classmethod
    def report(cls):
        done = subprocess.run([TOP / "tools" / "report", cls.out], check=True, capture_output=True, text=True)
        return Path(done.stdout.strip())

    def row(self, first):
        return next(row for row in self.page.rows if row and row[0] == first)

    def test_parts(self):
        self.assertEqual(self.page.headings[0], "Dam <break> & front")
        for heading in ("Against references", "Pictures", "Over time", "Where time went", "Scene as understood", "Log"):
            self.assertIn(heading, self.page.headings)
        self.assertIn('<p class="done">The run is done.</p>', self.text)
        self.assertEqual(self.row("particles")[1], "100")

    def test_references(self):
        """Volume is conserved to rounding; the other figures are the run's own beside what the scene says."""
        name, found, reference, _, unit, off, source = self.row("volume")
        self.assertEqual((found, reference, unit, off, source), ("20", "20", "m3", "+0.00 %", "conserved"))
        _, found, reference, own, unit, off, _ = self.row("front")
        self.assertEqual((reference, own, unit), ("3.1321", "± 0.01", "m"))
        self.assertAlmostEqual(float(off.removesuffix(" %")), 100 * (float(found) / 3.1321 - 1), delta=0.01)
        rows = [[float(cell) for cell in row.split(",")] for row in (self.out / "diagnostics.csv").read_text().splitlines()[1:]]
        columns = (self.out / "diagnostics.csv").read_text().splitlines()[0].split(",")
        front = np.interp(0.5, [row[1] for row in rows], [row[columns.index("greatest_x [m]")] for row in rows])
        self.assertAlmostEqual(float(found), front, delta=1e-4)
        self.assertEqual(self.row("later")[1], "not reached")
        self.assertEqual(self.row("ranks used")[1:3] + self.row("ranks used")[5:6], ["1", "4", "-75.00 %"])

    def test_one_file_that_loads_nothing(self):
        self.assertGreaterEqual(len(self.page.loads), 3)
        for load in self.page.loads:
            found = re.match(r"data:image/(png|svg\+xml);base64,", load)
            self.assertTrue(found, load[:60])
            data = base64.b64decode(load[found.end():])
            self.assertTrue(data.startswith(b"\x89PNG\r\n\x1a\n" if found[1] == "png" else b"<?xml"))

    def test_shown_by_chromium(self):
        """Every picture has a size, the console is empty; a page with an error and a broken picture is found out."""
        count = ('<script>document.body.dataset.broken = [...document.images].filter(i => !i.naturalWidth).length + " of "'
                 ' + document.images.length</script>')
        shown = self.folder / "shown.html"
        shown.write_text(self.text.replace("</body>", count + "</body>"))
        document, console = show(shown, self.folder)
        self.assertEqual(console, [])
        self.assertIn(f'data-broken="0 of {len(self.page.loads)}"', document)
        shown.write_text(self.text.replace("</body>", '<img src="data:image/png;base64,AAAA"><script>nothing()</script>'
                                           + count + "</body>"))
        document, console = show(shown, self.folder)
        self.assertIn("nothing is not defined", "".join(console))
        self.assertIn(f'data-broken="1 of {len(self.page.loads) + 1}"', document)

    def test_runs_that_did_not_end_well(self):
        saved = (self.out / "log.txt").read_text()
        begun = saved[: saved.index("\n", saved.index("bytes per particle")) + 1]
        self.addCleanup(lambda: ((self.out / "log.txt").write_text(saved), shutil.rmtree(self.out / "failed")))
        (self.out / "log.txt").write_text(saved + begun + "2026-01-01 00:00:00 note: <ice> ahead\n")
        text = self.report().read_text()
        self.assertIn("The run is not ended.", text)
        self.assertIn('<li class="note">&lt;ice&gt; ahead</li>', text)
        (self.out / "failed").mkdir()
        self.assertIn("The run is failed.", self.report().read_text())

    def test_bad_references_are_refused(self):
        for old, new, message in (('value = 4', 'value = "4 parsecs"', "reference"),
                                  ('"performance.json"', '"../performance.json"', "is not the name of"),
                                  ('name = "later"\n', "", "name")):
            (self.folder / "bad.toml").write_text(SCENE.replace(old, new))
            done = subprocess.run([TALUS, "check", self.folder / "bad.toml"], capture_output=True, text=True, env=ENVIRONMENT,
                                  stdin=subprocess.DEVNULL)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertRegex(done.stderr, rf"bad\.toml:\d+: .*{message}")

    def test_no_run(self):
        done = subprocess.run([TOP / "tools" / "report", self.folder], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is not the output folder of a run", done.stderr)


if __name__ == "__main__":
    unittest.main()
