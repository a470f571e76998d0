# SPDX-License-Identifier: Apache-2.0
"""The verbs that make pages, and their options."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Option:
    """An option with a value, or the list of files that a verb reads."""
    name: str              # "--out", or the name of the list
    sentence: str          # for --help
    value: str             # name of its value in --help
    default: str = None    # None: there is none
    is_required: bool = False
    is_list: bool = False

    @property
    def key(self):
        """The name of its value among all values."""
        return self.name.removeprefix("--")


@dataclass(frozen=True)
class Verb:
    """A program of a page."""
    sentence: str  # what it does, for --help
    module: str    # has run(values, complain), which returns the exit code
    options: tuple
    footer: str = ""


CHART_FOOTER = """\
A: speed against accuracy. B: where methods fail, and the failure atlas. C: error against degrees of freedom and time. Hardware: what
cameras and projectors bring. The charts need the results of these plans in config/sweeps: A and C ladder.toml, and times.toml for frame
times; B stress.toml and failures.toml; hardware.toml. scripts/charts runs all of them."""

BENCHMARK_FOOTER = """\
For a method of your own: --images DIR writes the images and times of all cases to DIR/benchmark/000 and so on, and to
DIR/benchmark_stress; put the results of your method into FOLDER/benchmark/000.csv (or .npy) and so on, and into
FOLDER/benchmark_stress for chart B; --landmarks FOLDER or --poses FOLDER then adds its row. docs/benchmark.md has the rules.
Recordings are read from HANDCAST_DATA; without them their cases are left out."""

VERBS = {
    "benchmark": Verb(
        "Scores the methods of a fixed set of motions, people, meshes and faults, and one of your own.",
        "pages.benchmark.write",
        (Option("--landmarks", "Adds a detector: the folder of its results, a file for each case", "FOLDER"),
         Option("--poses", "Adds a tracker: the same", "FOLDER"),
         Option("--name", "What it is called (default: mine)", "NAME"),
         Option("--images", "Scores nothing, and writes the images, times and true hands of all cases", "DIR"),
         Option("--out", "Folder for benchmark.json, benchmark.md, benchmark.html and the charts (default: out/benchmark)", "DIR",
                "out/benchmark"),
         Option("--people", "Takes N people in place of those of the benchmark, to check a row", "N"),
         Option("--jobs", "Number of simultaneous runs (default: one per core)", "N"),
         Option("--plans", "Folder of other plans of the same names", "DIR"),
         Option("--title", "Heading of the page", "TEXT", "handcast benchmark")),
        BENCHMARK_FOOTER),
    "calibration-page": Verb(
        "Makes report.html of what `handcast calibrate`, which calls this program, has measured.",
        "pages.calibration.write",
        (Option("--folder", "Folder of the calibration, with report.json; the page is written to it (required)", "DIR", is_required=True),)),
    "chart": Verb(
        "Draws the results of sweeps: a self-contained page, the charts as SVG, and the numbers behind them as CSV.",
        "pages.chart.write",
        (Option("results", "Files of `handcast sweep`", "RESULTS.csv", is_required=True, is_list=True),
         Option("--out", "Folder for charts.html, *.svg and *.csv (default: out/charts)", "DIR", "out/charts"),
         Option("--title", "Heading of the page", "TEXT", "handcast: speed against accuracy")),
        CHART_FOOTER),
    "report": Verb(
        "Makes report.html, metrics.json and preview.mp4 from the results of a demonstration.",
        "pages.report.write",
        (Option("--out", "Folder with baseline.json, paper.json, twin.json, live.json, observer.json and frames/; the report is "
                         "written to it (required)", "DIR", is_required=True),
         Option("--title", "Heading of the page", "TEXT", "handcast: light that stays on moving hands"))),
}
