# SPDX-License-Identifier: Apache-2.0
"""The runs of files of `handcast sweep`."""
import csv
import math
import pathlib
import re
import statistics
from dataclasses import dataclass, field

from pages.files import MOST_RESULTS, Problem, read_input

STAMP = "# handcast sweep "
MOST_RUNS = 10_000_000
NUMBER = re.compile(r"-?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)

# The settings of a rig that are in no section; all others have a dot in their paths, and metrics have none.
PLAIN_SETTINGS = ("name", "calibration")
LADDER_AXES = ("twin.motion", "twin.shape.mesh", "twin.speed", "twin.seed")
DETECTOR = "detector"  # the metric that is a word
TIMES_PLAN = "times"   # the plan that only measures the times of frames


def is_setting(column):
    """True for a column with a setting; False for one with a metric."""
    return "." in column or column in PLAIN_SETTINGS


def number_of(text):
    """A setting or metric as a number: "true" is 1, "false" is 0; None if it is none of these, or not finite."""
    if text in ("true", "false"):
        return float(text == "true")
    value = float(text) if NUMBER.fullmatch(text) else math.nan
    return value if math.isfinite(value) else None


@dataclass
class Run:
    """One scored run of a sweep."""
    plan: str
    variant: str
    settings: dict = field(default_factory=dict)  # values of the axes, by path
    metrics: dict = field(default_factory=dict)   # measured metrics, by column

    def turned(self):
        """The paths of the axes other than motion, mesh, speed and seed."""
        return sorted(path for path in self.settings if path not in LADDER_AXES)

    def number(self, path):
        """A setting as a number; None if it is no axis of the run's grid."""
        return number_of(self.settings.get(path, ""))


@dataclass
class Source:
    """Summary of one file of results."""
    plan: str
    planned: int     # runs of the plan
    is_ladder: bool  # the only axes are motion, mesh, speed and seed
    scored: int = 0
    failed: int = 0


@dataclass
class Results:
    """The runs of several files."""
    runs: list = field(default_factory=list)     # Run, in the order of the files
    sources: list = field(default_factory=list)  # Source, one for each file

    def plans(self, is_ladder):
        """The names of the plans with only the axes of a ladder, or with others."""
        return {source.plan for source in self.sources if source.is_ladder == is_ladder}

    def ladder(self):
        """The runs of the plans whose only axes are motion, mesh, speed and seed, without those that only measure times."""
        plans = self.plans(is_ladder=True) - {TIMES_PLAN}
        return [run for run in self.runs if run.plan in plans]

    def laboratory(self):
        """The runs of the plans with more axes."""
        plans = self.plans(is_ladder=True)
        return [run for run in self.runs if run.plan not in plans]


def lines_of(file):
    """The complete lines of a file of results: its first one, and the cells of all others. Raises Problem if it is not of a sweep."""
    text = read_input(file, MOST_RESULTS).decode("utf-8", "replace")
    stamp, *lines = text.split("\n")[:-1] or [""]
    if not stamp.startswith(STAMP) or not 0 < runs_of(stamp) <= MOST_RUNS:
        raise Problem(f"{file}: the file does not hold results of a sweep")
    try:
        return stamp, [next(csv.reader([line]), [""]) for line in lines]
    except csv.Error as error:
        raise Problem(f"{file}: the file cannot be read: {error}") from None


def after(stamp, key):
    """The text after " key=" in the first line, which plans have up to its end."""
    return stamp.partition(f" {key}=")[2]


def runs_of(stamp):
    """How many runs the whole plan has; 0 if the line does not say so."""
    digits = re.match(r"\d{1,9}", after(stamp, "runs"))
    return int(digits[0]) if digits else 0


def run_of(plan, columns, row, file):
    """The run of a line. Raises Problem if a metric is not a number."""
    run = Run(plan, row[1])
    for column, cell in zip(columns[2:-1], row[2:-1]):
        if cell and is_setting(column):
            run.settings[column] = cell
        elif cell and column != DETECTOR:
            run.metrics[column] = number_of(cell)
            if run.metrics[column] is None:
                raise Problem(f"{file}: run {row[0]}: {column} is '{cell}', which is not a number")
    return run


def read_file(file, results):
    """Adds the runs of a file. Raises Problem."""
    stamp, (columns, *rows) = (lambda stamp, lines: (stamp, lines or [[]]))(*lines_of(file))
    if len(columns) < 3 or columns[1] != "variant" or columns[-1] != "error":
        raise Problem(f"{file}: the file does not hold results of a sweep")
    source = Source(after(stamp, "plan"), runs_of(stamp), not any(is_setting(column) and column not in LADDER_AXES for column in columns))
    for number, row in enumerate(rows, 3):
        if len(row) != len(columns) or not row[0].isdecimal() or int(row[0]) >= source.planned:
            raise Problem(f"{file}:{number}: the line is not one of this sweep")
        if row[-1]:
            source.failed += 1
        else:
            results.runs.append(run_of(source.plan, columns, row, file))
            source.scored += 1
    if not source.scored:
        raise Problem(f"{file}: the file has no scored run")
    results.sources.append(source)


def read_results(files):
    """The runs of all files. Raises Problem if one cannot be read or is not of a sweep, has no scored run, or has a metric that is not
    a number."""
    results = Results()
    for file in files:
        read_file(pathlib.Path(file), results)
    return results


def mean_of(runs, column):
    """Mean of a metric over the runs that have it; None if none has."""
    values = [run.metrics[column] for run in runs if column in run.metrics]
    return statistics.fmean(values) if values else None


def largest_of(runs, column):
    """The largest value of a metric; None if no run has it."""
    return max((run.metrics[column] for run in runs if column in run.metrics), default=None)


def by_variant(runs):
    """The runs of each variant, in the order of the runs."""
    variants = {}
    for run in runs:
        variants.setdefault(run.variant, []).append(run)
    return variants
