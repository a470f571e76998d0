# SPDX-License-Identifier: Apache-2.0
"""Each figure that handcast prints is explained on docs/operating/figures.md.

The names are read in the sources of the printers. Each source must yield some, so that a printer that is written in
another way is noticed.
"""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = "docs/operating/figures.md"
# Words of the headings and keys that are no figures: names of things, and places in a table.
NO_FIGURES = {"rig", "rings", "service", "services", "stages", "stream", "streams", "ring", "reader", "who", "row", "log", "light",
              "motion", "mesh", "speed", "seed", "seconds", "software_ms", "why", "used", "trouble", "missing", "end_to_end",
              "left", "right", "begins_s", "ends_s", "is_held_to_it", "is_settled", "keeper_died", "autocorrelation", "slots",
              "readers", "last 10 s", "gone", "waiting", "copied", "lease_ages_ns"}
# The figure of the page for a name with another form in JSON.
SAME = {"uptime_s": "up", "standby_pid": "standby", "backend": "back end", "last_exit": "last exit", "cores": "CPU",
        "resident_bytes": "memory", "shared_bytes": "shared", "descriptors": "files", "last_core": "core",
        "scheduling": "class", "wanted_hz": "wanted", "held_hz": "held", "rate_hz": "rate", "newest_age_ms": "newest age",
        "newest_age_ns": "newest age", "latency_ns": "latency", "age_ns": "age", "dropped_hz": "dropped",
        "received": "read", "received_hz": "reads", "skipped_hz": "skipped", "lag": "behind", "epoch": "now",
        "unusable": "invalid messages", "stage_us": "stage", "skipped_ids": "skipped", "longest_gap_ms": "longest gap",
        "lost_marks": "marks lost", "count": "count", "lost images": "lost_images"}
PERCENTILE = re.compile(r"(p\d+|mean|max)(_us)?")

# A source, the expression whose groups are names, and the fewest names that it must yield.
PRINTERS = [
    ("supervisor/look/figures/figures.cpp", r'visit(?:\.or_null)?\("(\w+)"', 30),
    ("supervisor/look/figures/status_text.cpp", r'fmt::runtime\(kRow\), ((?:"[^"]+",?\s*)+)', 3),
    ("supervisor/look/trace/latency_print.cpp", r'\{"(\w+)", ', 15),
    ("supervisor/look/trace/latency_print.cpp", r'\\n", ((?:"[^"]+",?\s*)+)\);', 1),
    ("supervisor/look/top/top_layout.cpp", r'title = "[^\w"]*(\w[^"]*)"', 20),
    ("supervisor/look/top/top_layout.cpp", r'\{"([A-Z ]{4,})", Style::heading', 2),
    ("supervisor/look/top/top_json.cpp", r'(?:\{|object\[)"(\w+)"', 30),
    ("supervisor/look/metrics/metrics.cpp", r'"handcast_(\w+)"', 30),
    ("services/lab/twin/metrics.cpp", r'json\["(\w+)"\]', 18),
    ("services/lab/simulate/score.cpp", r'json\["(\w+)"\]', 8),
    ("services/lab/simulate/recovery.cpp", r'\{"(\w+)", ', 5),
    ("services/lab/simulate/detector_tally.cpp", r'\{"([a-z]\w+)",', 6),
    ("services/lab/simulate/run.cpp", r"[:;,] ([a-z][a-z ]+?)(?: mean)? \{\}", 4),
    ("services/observer/main.cpp", r"([a-z][a-z0-9 ]*[a-z0-9]) \{:", 3),
    ("services/tools/preview/layout/legend.cpp", r'"([ABCD]) [a-z ]+"', 4),
    ("scripts/pages/report/accuracy.py", r'", \("(\w+)"', 12),
    ("ipc/msg/stage_mark.hpp", r"kStageNames\{([^}]*)\}", 1),
    ("ipc/msg/rung.hpp", r"kRungNames\{([^}]*)\}", 1),
    ("ipc/msg/tracker_faults.hpp", r"kTrackerFaultNames\{([^}]*)\}", 1),
]


def names_in(source, expression):
    """The names that a printer has: each match is one, or a list of quoted ones."""
    code = re.sub(r"//.*", "", (ROOT / source).read_text(encoding="utf-8"))
    for match in re.findall(expression, code):
        yield from (name.strip() for name in (re.findall(r'"([^"]+)"', match) or [match]))


def words_of_the_tables():
    """The names in the cells of the page, lower case."""
    rows = [line for line in (ROOT / PAGE).read_text(encoding="utf-8").splitlines() if line.startswith("|")]
    return " " + re.sub(r"[^a-z0-9_. ]+", " ", " ".join(rows).lower()) + " "


class Figures(unittest.TestCase):
    def test_each_printed_figure_is_explained(self):
        page = words_of_the_tables()
        self.maxDiff = None
        absent = []
        for source, expression, fewest in PRINTERS:
            names = list(names_in(source, expression))
            with self.subTest(source=source, expression=expression):
                self.assertGreaterEqual(len(names), fewest, f"{source}: its names are no longer found")
            for name in names:
                if name.lower() in NO_FIGURES or PERCENTILE.fullmatch(name) or name.startswith("gpu_"):
                    continue
                shown = SAME.get(name, SAME.get(name.lower(), name)).lower()
                if f" {shown} " not in page:
                    absent.append(f"{source}: {name}")
        self.assertEqual(absent, [], f"not on {PAGE}")

    def test_an_absent_figure_would_be_found(self):
        self.assertNotIn(" a_figure_of_tomorrow ", words_of_the_tables())
        self.assertIn(" interior_mm ", words_of_the_tables())


if __name__ == "__main__":
    unittest.main()
