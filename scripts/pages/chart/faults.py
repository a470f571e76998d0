# SPDX-License-Identifier: Apache-2.0
"""The failures of a rig, and their effects on the methods: the rows of the failure atlas."""
import re
from dataclasses import dataclass, field

from pages.chart.results import by_variant, largest_of, mean_of

# In the order of the atlas: a sensor fails for a moment; a sensor or the image is bad for the whole run; no failure, but a difficult
# motion.
PASSING, LASTING, MOTION = range(3)
KIND_NAMES = ("for a moment", "for the whole run", "motion")

SAME_RECOVERY_MS = 2  # recoveries that differ by no more are the same: two refreshes of the projector

# The setting of a failure, its kind, its name with a place for the value, and the scale of the value.
FAULTS = {
    "twin.tracker.lost_s": (PASSING, "tracker silent, {:g} ms", 1e3),
    "twin.tracker.frozen_s": (PASSING, "tracker frozen, {:g} ms", 1e3),
    "twin.tracker.decaying_s": (PASSING, "tracker sinks to rest, {:g} ms", 1e3),
    "twin.tracker.wrong_finger_s": (PASSING, "tracker: wrong finger, {:g} ms", 1e3),
    "twin.tracker.merged_s": (PASSING, "tracker: fingers merged, {:g} ms", 1e3),
    "twin.tracker.swapped_s": (PASSING, "tracker: hands swapped, {:g} ms", 1e3),
    "twin.detector.lost_s": (PASSING, "landmarks lost, {:g} ms", 1e3),
    "twin.detector.wrong_finger_s": (PASSING, "landmarks: wrong finger, {:g} ms", 1e3),
    "twin.detector.merged_s": (PASSING, "landmarks: fingers merged, {:g} ms", 1e3),
    "twin.tracker.clock_skew_ms": (LASTING, "tracker clock {:+g} ms", 1),
    "twin.detector.clock_skew_ms": (LASTING, "detector clock {:+g} ms", 1),
    "twin.detector.outliers": (LASTING, "outliers, {:g} % of the landmarks", 100),
    "twin.detector.near_outliers": (LASTING, "outliers of 5-40 px, {:g} %", 100),
    "twin.image.dark": (LASTING, "image dark: {:g} % of the light", 100),
    "twin.image.saturated": (LASTING, "image saturated: {:g} times the light", 1),
    "twin.image.holes": (LASTING, "image with holes, {:g} % of the hand", 100),
    "twin.image.covered": (LASTING, "image covered, {:g} %", 100),
    "twin.image.face": (LASTING, "a face behind the hands", 1),
}


@dataclass
class Damage:
    """The effect of one failure on one method, over motions and seeds. None if not measured."""
    worst_mm: float     # largest landmark error; of passing failures only
    recovery_ms: float  # longest recovery; of passing failures only
    dark_ms: float      # longest time without light; of passing failures only
    p95_mm: float       # mean of the interior error's 95th percentile
    coverage: float     # mean
    spill: float        # mean
    foldovers: float    # largest number of a run
    never_good: int     # runs that ended before the light was good again

    def recovers_faster(self, other):
        """True if this method recovers from the failure and another one does not, or later."""
        if self.never_good or self.recovery_ms is None:
            return False
        return bool(other.never_good) or other.recovery_ms is not None and self.recovery_ms + SAME_RECOVERY_MS < other.recovery_ms


@dataclass
class Failure:
    """One failure and its effect."""
    name: str  # label in the atlas
    kind: int
    damage: dict = field(default_factory=dict)  # Damage by variant

    def paper_is_faster(self):
        """True if the paper's cascade recovers faster than ours."""
        paper, ours = self.damage.get("paper"), self.damage.get("handcast")
        return self.kind == PASSING and bool(paper and ours) and paper.recovers_faster(ours)


def damage_of(runs):
    """The effect on the runs of one method."""
    never_good = sum("fault_worst_mm" in run.metrics and "fault_recovery_ms" not in run.metrics for run in runs)
    return Damage(*(largest_of(runs, column) for column in ("fault_worst_mm", "fault_recovery_ms", "fault_dark_ms")),
                  *(mean_of(runs, column) for column in ("interior_mm_p95", "coverage", "spill")),
                  largest_of(runs, "foldovers"), never_good)


def failure_of(run):
    """The kind and the name of a run's failure: "landmarks lost, 600 ms + tracker frozen, 600 ms"; None if it is not of the atlas."""
    faults = [path for path in run.turned() if path in FAULTS]
    if run.number("twin.image.holes") == 0:
        return None
    if faults:
        values = (FAULTS[path][1].format((run.number(path) or 0) * FAULTS[path][2]) for path in faults)
        return FAULTS[faults[0]][0], " + ".join(values)
    if run.turned() or "twin.speed" in run.settings:
        return None
    return MOTION, re.split("[:/]", run.settings.get("twin.motion", ""))[-1].replace("_", " ")


def failures_of(results):
    """The failures of the results, ordered by kind. Several faults at once are one failure."""
    runs_of = {}
    for run in results.laboratory():
        if "interior_mm_p95" in run.metrics and (failure := failure_of(run)):
            runs_of.setdefault(failure, []).append(run)
    failures = [Failure(name, kind, {variant: damage_of(runs) for variant, runs in by_variant(runs_of[kind, name]).items()})
                for kind, name in runs_of]
    return sorted(failures, key=lambda failure: failure.kind)
