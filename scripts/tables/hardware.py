# SPDX-License-Identifier: Apache-2.0
"""The tables of docs/lab/charts.md about what hardware buys: each camera with each projector, each step to a faster one, and other
parts one at a time."""

import collections
import statistics

from tables.runs import die, interval, listed, rows_of

METHODS = ("handcast", "paper")
ERROR, LATENCY = "interior_mm_mean", "equivalent_latency_ms"
# The variants of hardware_parts.toml, all compared with the first one.
PARTS = {
    "usual": "camera 120 Hz, projector 120 Hz, 16 ms, tracker 110 Hz, 9 ms",
    "fast_tracker": "tracker 221 Hz, 5 ms",
    "slow_tracker": "tracker 60 Hz, 20 ms",
    "no_tracker": "no tracker",
    "weak_lamp": "a weaker lamp: exposure 8 ms instead of 4 ms",
    "mediapipe": "MediaPipe instead of our network",
}


class Cells:
    """The runs of a plan, by what `key_of(row)` makes of each; every key must have the same people and motions."""

    def __init__(self, path, plan, key_of):
        self.path, self.rows = path, collections.defaultdict(dict)
        rows, runs = rows_of(path, plan)
        if failed := next((row for row in rows if row["error"]), None):
            die(f"{path}: run {failed['index']} has failed: {failed['error']}")
        if len(rows) != runs:
            die(f"{path} has {len(rows)} of the {runs} runs of its plan")
        for row in rows:
            self.rows[key_of(row)][int(row["twin.seed"]), row["twin.motion"]] = row
        people = next(iter(self.rows.values())).keys()
        if any(of_key.keys() != people for of_key in self.rows.values()):
            die(f"{path}: some rigs have other people or motions than others")
        self.seeds = sorted({seed for seed, _ in people})
        self.motions = list(dict.fromkeys(motion.split(":")[-1] for _, motion in people))
        if len(self.seeds) < 2:
            die(f"{path} has fewer than two seeds")

    def of(self, key, name):
        """The mean of a figure over the motions, for each seed."""
        if key not in self.rows:
            die(f"{self.path} has no runs of {key}")
        return [statistics.fmean(number(row, name, self.path) for (of, _), row in self.rows[key].items() if of == seed)
                for seed in self.seeds]

    def footer(self, command):
        """Who was measured, doing what."""
        return f"Seeds {listed(self.seeds)}; motions {', '.join(self.motions)}." + (f" Made by `{command}`." if command else "")


def number(row, name, path):
    """A figure of a run."""
    try:
        return float(row[name])
    except (KeyError, ValueError):
        die(f"{path}: run {row['index']} has no number {name}")


def split_variant(variant, path):
    """Method and rate of the camera in Hz: "handcast_60" is ("handcast", 60)."""
    method, _, rate = variant.partition("_")
    if method not in METHODS or not rate.isdecimal():
        die(f"{path} has runs of {variant}; the variants of hardware are METHOD_HZ with {' or '.join(METHODS)}")
    return method, int(rate)


class Pairs(Cells):
    """The runs by (method, camera in Hz, projector, speed), of which a projector is (rate in Hz, lag in ms)."""

    def __init__(self, path):
        def key_of(row):
            projector = number(row, "projector.rate_hz", path), number(row, "projector.latency_ms", path)
            return *split_variant(row["variant"], path), projector, number(row, "twin.speed", path)

        super().__init__(path, "hardware", key_of)
        self.cameras, self.projectors, self.speeds = (sorted({key[i] for key in self.rows}) for i in (1, 2, 3))

    def gains(self, method, speed, before, after):
        """What the error loses from one choice of devices to another, for each seed; a choice is a list of (camera, projector)."""
        def errors(devices):
            return [statistics.fmean(values) for values in zip(*(self.of((method, *each, speed), ERROR) for each in devices))]

        return [old - new for old, new in zip(errors(before), errors(after))]


def name_of_speed(speed):
    return "natural speed" if speed == 1 else f"{speed:g} times as fast"


def name_of_projector(projector):
    return f"{projector[0]:g} Hz, {projector[1]:g} ms"


def table_of_pairs(pairs, speed):
    """A row for each method and camera, a column for each projector."""
    yield f"Mean error of the light in mm, and its equivalent latency in ms (median), {name_of_speed(speed)}:"
    yield ""
    yield "| method | camera | " + " | ".join(f"projector {name_of_projector(projector)}" for projector in pairs.projectors) + " |"
    yield "|---|---|" + "---|" * len(pairs.projectors)
    for method in METHODS:
        for camera in pairs.cameras:
            keys = [(method, camera, projector, speed) for projector in pairs.projectors]
            cells = [f"{interval(pairs.of(key, ERROR), 1)}; {statistics.median(pairs.of(key, LATENCY)):.1f}" for key in keys]
            yield f"| {method} | {camera} Hz | " + " | ".join(cells) + " |"
    yield ""


def steps_of(pairs):
    """(name, devices before, devices after) of each step to the next faster projector or camera, with all of the other kind."""
    for slow, fast in zip(pairs.projectors, pairs.projectors[1:]):
        yield (f"projector {name_of_projector(slow)} → {name_of_projector(fast)}",
               *([(camera, projector) for camera in pairs.cameras] for projector in (slow, fast)))
    for slow, fast in zip(pairs.cameras, pairs.cameras[1:]):
        yield f"camera {slow} → {fast} Hz", *([(camera, projector) for projector in pairs.projectors] for camera in (slow, fast))


def table_of_steps(pairs):
    """A row for each step, a column for each method and speed."""
    columns = [(method, speed) for method in METHODS for speed in pairs.speeds]
    yield "How many mm each step takes from the mean error, on average over the devices of the other kind:"
    yield ""
    yield "| step | " + " | ".join(f"{method}, {name_of_speed(speed)}" for method, speed in columns) + " |"
    yield "|---|" + "---|" * len(columns)
    for name, before, after in steps_of(pairs):
        yield f"| {name} | " + " | ".join(interval(pairs.gains(*column, before, after)) for column in columns) + " |"
    yield ""


def lines_of_pairs(path, command):
    """The lines of the tables of cameras and projectors."""
    pairs = Pairs(path)
    for speed in pairs.speeds:
        yield from table_of_pairs(pairs, speed)
    yield from table_of_steps(pairs)
    yield pairs.footer(command)


def lines_of_parts(path, command):
    """The lines of the table of other parts."""
    cells = Cells(path, "hardware_parts", lambda row: (row["variant"], number(row, "twin.speed", path)))
    speeds = sorted({speed for _, speed in cells.rows})
    yield "| | " + " | ".join(f"{name_of_speed(speed)}, mm | more than the first, mm" for speed in speeds) + " |"
    yield "|---|" + "---|---|" * len(speeds)
    for variant, words in PARTS.items():
        row = [words]
        for speed in speeds:
            mm, usual = (cells.of((each, speed), ERROR) for each in (variant, "usual"))
            more = "" if variant == "usual" else interval([a - b for a, b in zip(mm, usual)])
            row += [interval(mm, 1), more]
        yield "| " + " | ".join(row) + " |"
    yield ""
    yield cells.footer(command)


# The lines by name of the table.
TABLES = {"hardware": lines_of_pairs, "hardware_parts": lines_of_parts}
