# SPDX-License-Identifier: Apache-2.0
"""The methods that charts A and C compare."""
from dataclasses import dataclass, field

from pages.chart.methods import Method, method_of
from pages.chart.results import TIMES_PLAN, by_variant, mean_of


@dataclass
class Standing:
    """The figures of one method at one speed: means over motions and seeds, None if not measured."""
    method: Method
    speed: float  # factor of the motion's own speed
    runs: int     # how many
    # Motion to photon. The simulated software time is replaced by the measured time of a frame, if there is one; that of the paper is kept.
    photon_ms: float
    mean_mm: float  # interior error
    p95_mm: float   # the same, 95th percentile
    coverage: float
    spill: float
    jitter_px: float     # of the landmarks on slow hands, camera px
    landmarks_ms: float  # age of the landmarks
    frame_us: float      # median time of a frame on one core of this machine

    @property
    def point(self):
        """The place in chart A."""
        return self.photon_ms, self.p95_mm


@dataclass
class Ladder:
    """The standings of the plans whose only axes are motion, speed and seed."""
    speeds: list = field(default_factory=list)     # at most two: natural, and the fastest
    standings: list = field(default_factory=list)  # by speed, then by variant; all have p95_mm
    timed_alone: bool = False                      # the frame times are of the plan "times", which runs alone

    def at(self, speed):
        """The standings of one speed."""
        return [standing for standing in self.standings if standing.speed == speed]


def speed_of(run):
    """The factor of the motion's own speed."""
    speed = run.number("twin.speed")
    return 1 if speed is None else speed


def speeds_of(runs):
    """The natural speed and the fastest one of the runs."""
    speeds = {speed_of(run) for run in runs}
    return sorted({1 if 1 in speeds else min(speeds), max(speeds)}) if speeds else []


def name_of_speed(speed):
    """"natural speed", "3 times as fast"."""
    return "natural speed" if speed == 1 else f"{speed:g} times as fast"


def standing_of(variant, speed, runs):
    """The means of runs of one variant and speed."""
    columns = ("motion_to_photon_ms", "interior_mm_mean", "interior_mm_p95", "coverage", "spill", "landmark_jitter_px", "detector_age_ms",
               "frame_us_p50")
    return Standing(method_of(variant), speed, len(runs), *(mean_of(runs, column) for column in columns))


def timed_as(method):
    """The variant whose measured frame time is used for a method; "" if that of its rig is used. The detector does not delay the frames,
    and methods that cannot be built are given the time of handcast."""
    if method.variant == "paper":
        return ""
    return "handcast" if method.variant in ("paper_at_our_speed", "ideal") or method.detects else method.variant


def ladder_of(results):
    """The ladder of all results."""
    runs, timing = results.ladder(), [run for run in results.runs if run.plan == TIMES_PLAN]
    ladder = Ladder(speeds_of(runs), [], bool(timing))
    for speed in ladder.speeds:
        timed = by_variant([run for run in timing if speed_of(run) == speed])
        here = by_variant([run for run in runs if speed_of(run) == speed])
        for variant in by_variant(runs):
            standing = standing_of(variant, speed, here.get(variant, []))
            if ladder.timed_alone:
                standing.frame_us = mean_of(timed.get(variant, []), "frame_us_p50")
            simulated_ms = mean_of(here.get(variant, []), "software_ms")
            measured_us = mean_of(timed.get(timed_as(standing.method), []), "frame_us_p50")
            if None not in (standing.photon_ms, simulated_ms, measured_us):
                standing.photon_ms += measured_us / 1e3 - simulated_ms
            if standing.p95_mm is not None:
                ladder.standings.append(standing)
    return ladder
