#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of config/sweeps/installation.toml as a table into a document.

    results_table.py RESULTS.csv DOCUMENT.md

The table replaces what stands between the lines "<!-- installation: begin -->" and "<!-- installation: end -->".
scripts/results calls it.
"""

import collections
import csv
import math
import statistics
import sys

BEGIN, END = "<!-- installation: begin -->", "<!-- installation: end -->"
VARIANTS = ["baseline", "paper", "handcast", "handcast_as_detected"]
GOAL = 0.45  # of the paper's error
# Student's t, two-sided 95 %, by degrees of freedom; the normal distribution's beyond.
T95 = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
       2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045]


def mean_and_interval(values):
    """The mean of independent values and half of its 95 % interval."""
    freedom = len(values) - 1
    t = T95[freedom - 1] if freedom <= len(T95) else 1.96
    return statistics.fmean(values), t * statistics.stdev(values) / math.sqrt(len(values))


class Runs:
    """The figures of a sweep, by variant, motion and seed."""

    def __init__(self, path):
        self.rows = collections.defaultdict(dict)
        self.motions = []
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                motion = row["twin.motion"].split("/")[-1].removeprefix("builtin:")
                if motion not in self.motions:
                    self.motions.append(motion)
                self.rows[row["variant"], motion][int(row["twin.seed"])] = row
        if not self.motions:
            sys.exit(f"results_table.py: {path} has no runs")
        wanted = {seed for runs in self.rows.values() for seed in runs}
        self.seeds = sorted(seed for seed in wanted
                            if all(self.rows[variant, motion].get(seed, {}).get("interior_mm_mean")
                                   for variant in VARIANTS for motion in self.motions))
        self.left_out = sorted(wanted - set(self.seeds))
        if len(self.seeds) < 2:
            sys.exit(f"results_table.py: {path} has fewer than two seeds with all runs")

    def of(self, variant, motion, name):
        """The figure `name` for each seed."""
        return [float(self.rows[variant, motion][seed][name]) for seed in self.seeds]

    def mean(self, variant, motion, name):
        return statistics.fmean(self.of(variant, motion, name))

    def ratios(self, variant, motion):
        """The ratio of the mean errors, `variant` to paper, for each seed."""
        return [ours / theirs for ours, theirs in zip(self.of(variant, motion, "interior_mm_mean"),
                                                      self.of("paper", motion, "interior_mm_mean"))]


def table(runs):
    """The lines of the table."""
    yield ("| motion | baseline | paper | handcast | without `definitions` | lit points alone: paper | handcast "
           "| missing, %: paper, handcast | network, px | ratio | without `definitions` |")
    yield "|" + "---|" * 11

    def both(variant, motion, kind="interior"):
        return f"{runs.mean(variant, motion, kind + '_mm_mean'):.1f} / {runs.mean(variant, motion, kind + '_mm_p95'):.1f}"

    def interval(values):
        return "{:.2f} ± {:.2f}".format(*mean_and_interval(values))

    for motion in runs.motions:
        missing = [100 * runs.mean(variant, motion, "missing") for variant in ("paper", "handcast")]
        cells = [motion, *(both(variant, motion) for variant in VARIANTS), both("paper", motion, "lit"),
                 both("handcast", motion, "lit"), "{:.1f}, {:.1f}".format(*missing),
                 f"{runs.mean('handcast', motion, 'detector_px_mean'):.1f}",
                 interval(runs.ratios("handcast", motion)), interval(runs.ratios("handcast_as_detected", motion))]
        yield "| " + " | ".join(cells) + " |"
    yield ""
    all_ratios = {variant: [statistics.fmean(of_seed) for of_seed in
                            zip(*(runs.ratios(variant, motion) for motion in runs.motions))]
                  for variant in ("handcast", "handcast_as_detected")}
    cells = [ratio for motion in runs.motions for ratio in runs.ratios("handcast", motion)]
    mean = statistics.fmean(all_ratios["handcast"])
    yield (f"Seeds {', '.join(map(str, runs.seeds))}. Mean of the ratios: {interval(all_ratios['handcast'])}, without "
           f"`definitions` {interval(all_ratios['handcast_as_detected'])}; the goal of {GOAL} is "
           f"{'reached' if mean <= GOAL else 'missed'}. Ours is worse than the paper's in "
           f"{sum(ratio > 1 for ratio in cells)} of {len(cells)} cells of motion and seed; the largest ratio is {max(cells):.2f}.")
    if runs.left_out:
        yield f"Left out, because runs failed: the seeds {', '.join(map(str, runs.left_out))}."


def main():
    if len(sys.argv) != 3 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    lines = list(table(Runs(sys.argv[1])))
    with open(sys.argv[2], encoding="utf-8") as file:
        text = file.read()
    if BEGIN not in text or END not in text.split(BEGIN, 1)[1]:
        sys.exit(f"results_table.py: {sys.argv[2]} has no lines {BEGIN} and {END}")
    before, rest = text.split(BEGIN, 1)
    after = rest.split(END, 1)[1]
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(before + BEGIN + "\n" + "\n".join(lines) + "\n" + END + after)


main()
