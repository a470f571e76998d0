# SPDX-License-Identifier: Apache-2.0
"""Settings that are made worse step by step, and the metrics that suffer from them: the panels of chart B."""
from dataclasses import dataclass

from pages.chart.analysis import breakdown_point
from pages.chart.methods import Method, method_of
from pages.chart.results import by_variant, mean_of


@dataclass(frozen=True)
class Stress:
    """A panel of chart B. Its harm is the error of the light: the error of the landmarks would leave the registration out."""
    setting: str  # path of the axis of the sweep
    title: str
    unit: str          # of the x axis
    scale: float = 1   # from the setting to the unit
    measure: str = ""  # column of the x axis; "" for the setting itself
    harm: str = "interior_mm_mean"  # column of the y axis
    harm_title: str = "interior error, mean, mm"
    is_of_one: bool = False  # the y axis shows 1 - harm, in percent


STRESSES = (
    Stress("twin.tracker.age_ms", "tracker age", "ms"),
    Stress("twin.tracker.dropout", "tracker samples lost", "%", 100),
    Stress("twin.detector.noise_px", "landmark noise", "px"),
    Stress("twin.detector.age_ms", "landmark age", "ms, back to back (100 ms: 10 Hz)"),
    Stress("twin.image.holes", "holes in the camera image", "% of the hand", 100, "", "coverage", "hand without light, %", True),
    Stress("twin.speed", "hand speed", "m/s", 1, "hand_speed_m_s_p95"),
)


@dataclass
class Line:
    """One method under a stress. `points` has a pair of stress and harm for each level, the value of the setting, in ascending order."""
    method: Method
    levels: list
    points: list

    @property
    def breakdown(self):
        """The point at which the harm has doubled; None if it never does."""
        return breakdown_point(self.points)

    def harm_at(self, level):
        """The harm at a level; None if there is no point."""
        return self.points[self.levels.index(level)][1] if level in self.levels else None


def is_under(run, stress):
    """True if the only axis of a run, motion and seed aside, is the setting of the stress."""
    if stress.setting == "twin.speed":
        return not run.turned() and "twin.speed" in run.settings
    return run.turned() == [stress.setting]


def point_of(stress, level, runs):
    """The point of the runs at a level; None if a figure was not measured."""
    x = mean_of(runs, stress.measure) if stress.measure else level * stress.scale
    y = mean_of(runs, stress.harm)
    if x is None or y is None:
        return None
    return x, 100 * (1 - y) if stress.is_of_one else y


def lines_of(results, stress):
    """The methods under a stress; none if the results have no runs of it. Speed is no stress in a ladder."""
    lines = []
    for variant, runs in by_variant([run for run in results.laboratory() if is_under(run, stress)]).items():
        by_level = {}
        for run in runs:
            if (level := run.number(stress.setting)) is not None:
                by_level.setdefault(level, []).append(run)
        points = {level: point_of(stress, level, by_level[level]) for level in sorted(by_level)}
        known = {level: point for level, point in points.items() if point}
        if known:
            lines.append(Line(method_of(variant), list(known), list(known.values())))
    return lines
