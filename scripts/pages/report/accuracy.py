# SPDX-License-Identifier: Apache-2.0
"""The metrics of `docs/method.md#metrics`, each with an explanation."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Metric:
    """A row of the table of accuracy."""
    name: str
    unit: str
    place: tuple   # in the results of a run
    factor: float  # from the results to the unit
    digits: int
    best: object   # a function of the values of all runs
    reading: str   # the explanation


def nearest_to_zero(values):
    """The value that is nearest to 0."""
    return min(values, key=abs)


METRICS = (
    Metric("Interior error, mean", "mm", ("interior_mm", "mean"), 1, 2, min,
           "Distance on the skin between a point and the point whose picture falls on it, over all visible points; 20 mm where there is "
           "no light."),
    Metric("Interior error, p95", "mm", ("interior_mm", "p95"), 1, 2, min, "95 % of the points have a smaller error."),
    Metric("Interior error, p99", "mm", ("interior_mm", "p99"), 1, 2, min,
           "99 % of the points have a smaller error. The larger ones are noticed in fast motion."),
    Metric("Interior error, p95", "projector px", ("interior_px", "p95"), 1, 2, min, "The 95th percentile in pixels of the projector."),
    Metric("Missing", "%", ("missing",), 100, 2, min, "Share of the points of the skin that have no light of their hand."),
    Metric("Coverage", "%", ("coverage",), 100, 2, max, "Share of the hand that is lit. Unlit parts appear as dark rims."),
    Metric("Spill", "%", ("spill",), 100, 2, min, "Area of the light beside the hand, as a share of the hand."),
    Metric("Overlap (IoU)", "", ("iou",), 1, 4, max,
           "Area of the lit hand divided by the area of hand and light together; 1 is a perfect outline."),
    Metric("Seam", "px", ("seam_px",), 1, 1, min, "Length of the edge of the light that runs across the hand instead of around it."),
    Metric("Jitter", "px RMS", ("jitter_px",), 1, 3, min,
           "Trembling of the light on a slow hand in 1-30 Hz, where people see it. Measured if more than 60 frames a second are scored."),
    Metric("Fold-overs", "", ("foldovers",), 1, 0, min,
           "Triangles of the drawn hand that the correction has turned over. There should be none."),
    Metric("Equivalent latency", "ms", ("equivalent_latency_ms",), 1, 2, nearest_to_zero,
           "The delay that explains the error best. It means little for a hand that hardly moves."),
    Metric("Noticed delay", "ms", ("jnd_ms",), 1, 2, max,
           "The delay that a viewer would notice in 75 % of the comparisons with perfect light, by a model: edges of the light inside the "
           "hand tell more than its picture. Ten people noticed 3.1 ms without and 6.6 ms with the fill."),
    Metric("Latency, in noticed delays", "", ("late_jnds",), 1, 2, min,
           "The equivalent latency relative to the noticed delay: below 1, most viewers do not see that the light is late."),
    Metric("Residual", "px RMS", ("residual_px",), 1, 2, min, "The error that no delay explains."),
    Metric("Frame, p50", "µs", ("frame_us", "p50"), 1, 0, min,
           "Median software time of one projector frame on the machine that ran the simulation."),
    Metric("Frame, p99", "µs", ("frame_us", "p99"), 1, 0, min, "99 % of the frames take less time."),
)


def row_of(metric, runs):
    """A metric with a pair for each run: its value in the unit, and whether it is the best one."""
    values = [run.metrics.number(*metric.place) for run in runs]
    known = [value for value in values if value is not None]
    best = metric.best(known) if len(set(known)) > 1 else None
    return metric, [(None if value is None else value * metric.factor, value is not None and value == best) for value in values]


def detector_of(run):
    """What found the landmarks of a run: None if they were not used, else the back end, "" if it is unknown."""
    if run.metrics.value("detector", "used") is False:
        return None
    backend = run.metrics.value("detector", "backend")
    return backend if isinstance(backend, str) else ""


def replaced_detectors(runs):
    """A sentence for each run that had another detector than its rig names."""
    reasons = [(run.name, run.metrics.value("detector", "why")) for run in runs]
    return [f"{name}: {why}." for name, why in reasons if isinstance(why, str)]
