# SPDX-License-Identifier: Apache-2.0
"""What cameras and projectors bring: the plan "hardware", whose variants are a method with a camera, "handcast_60"."""
from dataclasses import dataclass

from pages.chart.ladder import speed_of
from pages.chart.methods import Method, method_of
from pages.chart.results import mean_of

HARDWARE_PLAN = "hardware"


@dataclass(frozen=True, order=True)
class Projector:
    """A projector. They are ordered by their rates."""
    rate_hz: float
    lag_ms: float  # from a frame handed over to its light

    @property
    def name(self):
        """Its name in tables."""
        return f"{self.rate_hz:g} Hz, {self.lag_ms:g} ms"


@dataclass
class Pair:
    """The figures of a method with a camera and a projector at one speed: means over motions and seeds."""
    method: Method
    speed: float
    camera_hz: int
    projector: Projector
    runs: int
    mean_mm: float     # interior error
    p95_mm: float
    off_10mm: float    # share that is dark or more than 10 mm off
    latency_ms: float  # equivalent latency
    photon_ms: float   # motion to photon


def key_of(run):
    """What the runs of a pair have in common; None if the run is none of a pair."""
    variant, _, rate = run.variant.partition("_")
    projector = Projector(run.number("projector.rate_hz"), run.number("projector.latency_ms"))
    if not rate.isdecimal() or None in (projector.rate_hz, projector.lag_ms):
        return None
    return variant, speed_of(run), int(rate), projector


def pairs_of(results):
    """The pairs of all results, in the order of the runs."""
    runs_of = {}
    for run in results.runs:
        if run.plan == HARDWARE_PLAN and "interior_mm_mean" in run.metrics and (key := key_of(run)):
            runs_of.setdefault(key, []).append(run)
    columns = ("interior_mm_mean", "interior_mm_p95", "off_10mm", "equivalent_latency_ms", "motion_to_photon_ms")
    return [Pair(method_of(variant), speed, camera_hz, projector, len(runs), *(mean_of(runs, column) for column in columns))
            for (variant, speed, camera_hz, projector), runs in runs_of.items()]
