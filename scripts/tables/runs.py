# SPDX-License-Identifier: Apache-2.0
"""The runs of a sweep, and means with intervals over its seeds."""

import collections
import copy
import csv
import math
import statistics
import sys

# Student's t, two-sided 95 %, by degrees of freedom; the normal distribution's beyond.
T95 = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131,
       2.120, 2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045]


def die(message):
    sys.exit(f"results_table.py: {message}")


def mean_and_interval(values):
    """The mean of independent values and half of its 95 % interval."""
    freedom = len(values) - 1
    t = T95[freedom - 1] if freedom <= len(T95) else 1.96
    return statistics.fmean(values), t * statistics.stdev(values) / math.sqrt(len(values))


def interval(values, digits=2):
    """The mean with its interval; of two values the mean with both, as an interval of two says nothing."""
    if len(values) < 3:
        return f"{statistics.fmean(values):.{digits}f} ({', '.join(f'{value:.{digits}f}' for value in values)})"
    mean, half = mean_and_interval(values)
    return f"{mean:.{digits}f} ± {half:.{digits}f}"


def listed(seeds):
    """1, 2, 3, 7 as "1-3, 7"."""
    spans = []
    for seed in seeds:
        if spans and seed == spans[-1][1] + 1:
            spans[-1][1] = seed
        else:
            spans.append([seed, seed])
    return ", ".join(str(a) if a == b else f"{a}-{b}" for a, b in spans)


def is_count(text):
    """True for a whole number that is not absurdly large."""
    return text.isdecimal() and len(text) <= 9


def rows_of(path, plan):
    """The rows of a file of results of `plan`, and how many runs that plan has."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            lines = file.read().splitlines()
    except (OSError, UnicodeDecodeError) as error:
        die(f"{path} cannot be read: {error}")
    stamp = dict(word.split("=", 1) for word in lines[0].split() if "=" in word) if lines else {}
    if not lines or not lines[0].startswith("# handcast sweep ") or not is_count(stamp.get("runs", "")):
        die(f"{path} is not a file of results of handcast sweep")
    if stamp.get("plan") != plan:
        die(f"{path} has the results of the plan {stamp.get('plan')}, and not of {plan}")
    reader = csv.DictReader(lines[1:])
    try:
        rows = list(reader)
    except csv.Error as error:
        die(f"{path} cannot be read: {error}")
    if missing := [name for name in ("index", "variant", "twin.motion", "twin.seed", "interior_mm_mean", "error")
                   if name not in (reader.fieldnames or [])]:
        die(f"{path} has no column {missing[0]}")
    for number, row in enumerate(rows, start=3):
        if None in row or None in row.values() or not is_count(row["twin.seed"]):
            die(f"{path}:{number}: is not the row of a run")
    return rows, int(stamp["runs"])


class Runs:
    """The figures of the sweep of `plan`, by variant, motion and seed; if the sweep has several meshes, a motion is a pair of both.
    Seeds of which a run failed are left out, and variants that have no run at all."""

    def __init__(self, path, wanted, plan):
        self.path, self.part = path, plan
        self.rows = collections.defaultdict(dict)
        self.motions, self.meshes, self.errors = [], [], {}
        rows, runs = rows_of(path, plan)
        self.missing = runs - len({row["index"] for row in rows})
        if self.missing < 0:
            die(f"{path} has {-self.missing} runs more than its plan")
        for row in rows:
            motion = row["twin.motion"].split("/")[-1].removeprefix("builtin:")
            if mesh := row.get("twin.shape.mesh"):
                motion = (mesh, motion)
                if mesh not in self.meshes:
                    self.meshes.append(mesh)
            if motion not in self.motions:
                self.motions.append(motion)
            of_cell, seed = self.rows[row["variant"], motion], int(row["twin.seed"])
            if seed in of_cell:
                die(f"{path} has two runs of {row['variant']}, {row['twin.motion']} and seed {seed}")
            of_cell[seed] = row
            if not row["interior_mm_mean"]:
                self.errors.setdefault(row["variant"], row["error"])
        if not self.motions:
            die(f"{path} has no runs")
        if strange := sorted({variant for variant, _ in self.rows} - set(wanted)):
            die(f"{path} has runs of {', '.join(strange)}, for which the table has no row")
        if self.meshes and not all(isinstance(motion, tuple) for motion in self.motions):
            die(f"{path} has runs with a mesh and others without")
        self.variants = [variant for variant in wanted if any(
            row["interior_mm_mean"] for motion in self.motions for row in self.rows[variant, motion].values())]
        self.absent = [variant for variant in wanted if variant not in self.variants]
        seeds = {seed for runs in self.rows.values() for seed in runs}
        self.seeds = sorted(seed for seed in seeds
                            if all(self.rows[variant, motion].get(seed, {}).get("interior_mm_mean")
                                   for variant in self.variants for motion in self.motions))
        self.left_out = sorted(seeds - set(self.seeds))
        if len(self.seeds) < 2:
            die(f"{path} has fewer than two seeds with all runs")

    def of_mesh(self, mesh):
        """The same runs, of one mesh alone."""
        part = copy.copy(self)
        part.motions = [motion for motion in self.motions if motion[0] == mesh]
        return part

    def of(self, variant, motion, name):
        """The figure `name` for each seed."""
        return [self.figure(self.rows[variant, motion][seed], name) for seed in self.seeds]

    def figure(self, row, name):
        """A figure of a run. Only a latency may be negative."""
        try:
            value = float(row[name])
        except KeyError:
            die(f"{self.path} has no column {name}")
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or (value < 0 and name != "equivalent_latency_ms"):
            die(f"{self.path}: {name} of run {row['index']} is '{row[name]}', which is not a figure of a run")
        return value

    def mean(self, variant, motion, name):
        """The mean over the seeds, or over all motions and seeds if `motion` is None."""
        motions = self.motions if motion is None else [motion]
        return statistics.fmean(statistics.fmean(self.of(variant, each, name)) for each in motions)

    def both(self, variant, motion, kind="interior"):
        """Mean and p95 in mm."""
        return f"{self.mean(variant, motion, kind + '_mm_mean'):.1f} / {self.mean(variant, motion, kind + '_mm_p95'):.1f}"

    def percent(self, variant, name, motion=None):
        """The mean of a share in percent, over all motions and seeds if `motion` is None."""
        return f"{100 * self.mean(variant, motion, name):.1f}"

    def ratios(self, variant, reference, motion, name="interior_mm_mean"):
        """The ratio of the mean errors for each seed."""
        pairs = list(zip(self.of(variant, motion, name), self.of(reference, motion, name)))
        if not all(theirs > 0 for _, theirs in pairs):
            die(f"{self.path}: an error of {reference} is 0, so that nothing can be compared with it")
        return [ours / theirs for ours, theirs in pairs]

    def ratios_of_all(self, variant, reference, name="interior_mm_mean"):
        """The mean of these ratios over all motions, for each seed."""
        return [statistics.fmean(of_seed) for of_seed in
                zip(*(self.ratios(variant, reference, motion, name) for motion in self.motions))]

    def lost(self, ours, theirs, name="interior_mm_mean"):
        """In how many cells of motion and seed `ours` has the larger figure, and in how many it has any."""
        pairs = [pair for motion in self.motions for pair in zip(self.of(ours, motion, name), self.of(theirs, motion, name))]
        return sum(a > b for a, b in pairs), len(pairs)

    def largest_ratio(self, variant, reference):
        """The largest ratio of the mean errors of all cells."""
        return max(max(self.ratios(variant, reference, motion)) for motion in self.motions)

    def detector(self, variant):
        """The back end that has found the landmarks, and its age."""
        rows = [self.rows[variant, motion][seed] for motion in self.motions for seed in self.seeds]
        names = sorted({row.get("detector", "") for row in rows})
        if len(names) > 1:
            die(f"{self.path}: the runs of {variant} have different detectors: {', '.join(names)}")
        return ", ".join(names + sorted({f"{self.figure(row, 'detector_age_ms'):g} ms" for row in rows}))

    def has(self, variant):
        return variant in self.variants

    def only_motion(self):
        """The motion of a sweep of one; ends the program if there are more."""
        if len(self.motions) != 1:
            die(f"this table is of one motion, and the runs are of {len(self.motions)}")
        return self.motions[0]

    def cell_name(self):
        """What a cell of the table is."""
        return "mesh, motion and seed" if self.meshes else "motion and seed"

    def require_all(self):
        """Ends the program if runs of the plan are absent."""
        if self.missing:
            die(f"{self.path} lacks {self.missing} runs of its plan: recordings or hands were not there, or the sweep was interrupted")

    def require_meshes(self):
        """Ends the program if the sweep is of one mesh."""
        if not self.meshes:
            die(f"{self.path} has no runs of several meshes")

    def require(self, variants):
        """Ends the program if one of the variants has no runs."""
        for variant in variants:
            if not self.has(variant):
                die(f"{self.path} has no runs of {variant}")
