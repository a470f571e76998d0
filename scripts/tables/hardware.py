# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/lab/charts.md about what hardware buys: each camera with each projector, and each step to a faster one."""

import collections
import statistics

from tables.runs import die, interval, listed, rows_of

PLAN = "hardware"
METHODS = ("handcast", "paper")
ERROR, LATENCY = "interior_mm_mean", "equivalent_latency_ms"


def split_variant(variant, path):
    """Method and rate of the camera in Hz: "handcast_60" is ("handcast", 60)."""
    method, _, rate = variant.partition("_")
    if method not in METHODS or not rate.isdecimal():
        die(f"{path} has runs of {variant}; the variants of {PLAN} are METHOD_HZ with {' or '.join(METHODS)}")
    return method, int(rate)


class Pairs:
    """The figures of all pairs. A pair is (method, camera, projector, speed), of which a projector is (rate in Hz, lag in ms)."""

    def __init__(self, path):
        self.path = path
        rows, runs = rows_of(path, PLAN)
        if failed := next((row for row in rows if row["error"]), None):
            die(f"{path}: run {failed['index']} has failed: {failed['error']}")
        if len(rows) != runs:
            die(f"{path} has {len(rows)} of the {runs} runs of its plan")
        self.rows = collections.defaultdict(dict)
        for row in rows:
            method, camera = split_variant(row["variant"], path)
            projector = self.number(row, "projector.rate_hz"), self.number(row, "projector.latency_ms")
            pair = method, camera, projector, self.number(row, "twin.speed")
            self.rows[pair][int(row["twin.seed"]), row["twin.motion"]] = row
        self.cameras, self.projectors, self.speeds = (sorted({pair[i] for pair in self.rows}) for i in (1, 2, 3))
        cells = next(iter(self.rows.values())).keys()
        if len(self.rows) != len(METHODS) * len(self.cameras) * len(self.projectors) * len(self.speeds) or any(
                of_pair.keys() != cells for of_pair in self.rows.values()):
            die(f"{path}: some pairs of camera and projector have other runs than others")
        self.seeds = sorted({seed for seed, _ in cells})
        self.motions = sorted({motion.split(":")[-1] for _, motion in cells})
        if len(self.seeds) < 2:
            die(f"{path} has fewer than two seeds")

    def number(self, row, name):
        """A figure of a run."""
        try:
            return float(row[name])
        except (KeyError, ValueError):
            die(f"{self.path}: run {row['index']} has no number {name}")

    def of(self, pair, name):
        """The mean of a figure over the motions, for each seed."""
        return [statistics.fmean(self.number(row, name) for (of, _), row in self.rows[pair].items() if of == seed)
                for seed in self.seeds]

    def gains(self, method, speed, before, after):
        """What the error loses from one choice of devices to another, for each seed; a choice is a list of (camera, projector)."""
        def errors(devices):
            return [statistics.fmean(values) for values in zip(*(self.of((method, *each, speed), ERROR) for each in devices))]

        return [old - new for old, new in zip(errors(before), errors(after))]


def name_of_speed(speed):
    return "natural speed" if speed == 1 else f"{speed:g} times as fast"


def name_of_projector(projector):
    return f"{projector[0]:g} Hz, {projector[1]:g} ms"


def steps_of(pairs):
    """(name, devices before, devices after) of each step to the next faster camera or projector, with all of the other kind."""
    for slow, fast in zip(pairs.projectors, pairs.projectors[1:]):
        yield (f"projector: {name_of_projector(slow)} → {name_of_projector(fast)}",
               *([(camera, projector) for camera in pairs.cameras] for projector in (slow, fast)))
    for slow, fast in zip(pairs.cameras, pairs.cameras[1:]):
        yield (f"camera: {slow} → {fast} Hz", *([(camera, projector) for projector in pairs.projectors] for camera in (slow, fast)))


def table_of_pairs(pairs, speed):
    """A row for each method and camera, a column for each projector."""
    yield f"Error of the light at {name_of_speed(speed)}, mean in mm; its equivalent latency in ms:"
    yield ""
    yield "| method | camera | " + " | ".join(f"projector {name_of_projector(projector)}" for projector in pairs.projectors) + " |"
    yield "|---|---|" + "---|" * len(pairs.projectors)
    for method in METHODS:
        for camera in pairs.cameras:
            cells = [f"{interval(pairs.of((method, camera, projector, speed), ERROR), 1)}; "
                     f"{statistics.fmean(pairs.of((method, camera, projector, speed), LATENCY)):+.1f}" for projector in pairs.projectors]
            yield f"| {method} | {camera} Hz | " + " | ".join(cells) + " |"
    yield ""


def table_of_steps(pairs):
    """A row for each step, a column for each method and speed."""
    columns = [(method, speed) for method in METHODS for speed in pairs.speeds]
    yield "How many mm each step takes from the error, the mean over all devices of the other kind:"
    yield ""
    yield "| step | " + " | ".join(f"{method}, {name_of_speed(speed)}" for method, speed in columns) + " |"
    yield "|---|" + "---|" * len(columns)
    for name, before, after in steps_of(pairs):
        yield f"| {name} | " + " | ".join(interval(pairs.gains(*column, before, after), 1) for column in columns) + " |"
    yield ""


def lines_of(path, command):
    """The lines of the tables."""
    pairs = Pairs(path)
    for speed in pairs.speeds:
        yield from table_of_pairs(pairs, speed)
    yield from table_of_steps(pairs)
    text = f"Seeds {listed(pairs.seeds)}; motions {', '.join(pairs.motions)}."
    yield text + (f" Made by `{command}`." if command else "")
