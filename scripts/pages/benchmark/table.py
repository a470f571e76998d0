# SPDX-License-Identifier: Apache-2.0
"""The table of the benchmark: a row for each method, with the cases in which it is worse than the paper's method at the same times."""
import json
import statistics

from pages.benchmark.plans import PLANS, VERSION
from pages.chart.chart import Chart
from pages.chart.methods import method_of
from pages.chart.results import mean_of
from pages.chart.table import Column, NumberTable

REFERENCE = "paper_at_our_speed"
AXES = ("twin.motion", "twin.shape.mesh", "twin.seed")
FIGURES = {"mean_mm": "interior_mm_mean", "p95_mm": "interior_mm_p95", "coverage": "coverage", "spill": "spill",
           "off_10mm": "off_10mm", "detector_age_ms": "detector_age_ms"}

READING = (
    "The error of the light inside the hand; a point without light counts as 20 mm. The ratio is the mean over the cases of a method's mean "
    "error to that of the paper's method with our network and our times. A case is a motion of a person with one mesh.")


def case_of(run):
    """What a run is of, for people: "grasp, webxr, 101"."""
    return ", ".join(run.settings[axis].split("/")[-1].removeprefix("builtin:") for axis in AXES if axis in run.settings)


def by_case(runs, variant):
    """The runs of a method by case."""
    return {case_of(run): run for run in runs if run.variant == variant}


def row_of(variant, runs):
    """The figures of a method."""
    own, reference = by_case(runs, variant), by_case(runs, REFERENCE)
    error = FIGURES["mean_mm"]
    pairs = [(own[case].metrics[error], reference[case].metrics[error]) for case in own
             if case in reference and error in own[case].metrics and reference[case].metrics.get(error)]
    figures = {name: mean_of(list(own.values()), column) for name, column in FIGURES.items()}
    return {"name": variant, "cases": len(own), **figures,
            "ratio": statistics.fmean(mine / theirs for mine, theirs in pairs) if pairs else None,
            "worse": sum(mine > theirs for mine, theirs in pairs), "compared": len(pairs),
            "of_cases": {case: run.metrics.get(error) for case, run in sorted(own.items())}}


def rows_of(results):
    """The rows of all methods, in the order of the plan."""
    runs = [run for run in results.runs if run.plan == PLANS[0]]
    return [row_of(variant, runs) for variant in dict.fromkeys(run.variant for run in runs)]


def chart_of(rows, planned):
    """The table on the page. `planned`: the cases of the benchmark."""
    table = NumberTable("benchmark", f"The benchmark has {planned} cases, of which those are left out whose recordings or hands are not "
                        "on this machine. Simulated: the same on all machines.", [
                            Column("method", "method"), Column("mean_mm", "mean, mm"), Column("p95_mm", "p95, mm"),
                            Column("ratio", "ratio to the paper at our speed"), Column("worse", "worse in", 0),
                            Column("compared", "of", 0), Column("coverage", "coverage", 3), Column("spill", "spill", 3),
                            Column("off_10mm", "dark or > 10 mm off", 3), Column("detector_age_ms", "landmark age, ms", 1),
                            Column("cases", "cases", 0)])
    for row in rows:
        table.rows.append([method_of(row["name"]).label, *(row[column.key] for column in table.columns[1:])])
    return Chart("benchmark", f"Benchmark {VERSION}", READING, tables=[table])


def text_of(figure, digits):
    """A figure for people; a dash for one that no run has."""
    return "–" if figure is None else f"{figure:.{digits}f}"


def markdown(rows):
    """The same as a table for a README."""
    yield "| method | error of the light, mean / p95 mm | ratio | worse in (cases) |"
    yield "|---|---|---|---|"
    for row in rows:
        yield (f"| {method_of(row['name']).label} | {text_of(row['mean_mm'], 1)} / {text_of(row['p95_mm'], 1)} | "
               f"{text_of(row['ratio'], 2)} | {row['worse']} of {row['compared']} |")


def as_json(rows, planned, facts):
    """The bytes of benchmark.json."""
    return (json.dumps({"benchmark": VERSION, **facts, "planned_cases": planned, "reference": REFERENCE, "rows": rows}, indent=2) +
            "\n").encode()
