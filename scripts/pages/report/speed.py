# SPDX-License-Identifier: Apache-2.0
"""Error and coverage by the speed of the hand."""
from dataclasses import dataclass

BAR_PX, GAP_PX = 40, 4


@dataclass
class Bar:
    """A bar of the chart, in its pixels."""
    name: str  # of the run
    x: float
    height: float
    value: float  # None: not measured


@dataclass
class BarChart:
    """A bar chart of the 95th percentile: a group of bars for each bin, with the x of its middle."""
    groups: list  # triples of a bin, the middle and the bars
    width: int = 840
    height: int = 170
    top: int = 18
    bar: int = BAR_PX


def bins_of(runs):
    """The bins in which any run scored a frame. Their names ("0-0.1" … ">1.0") sort by speed."""
    bins = {name for run in runs for name in run.metrics.value("bins") or {}}
    return sorted(name for name in bins if any((run.metrics.number("bins", name, "frames") or 0) > 0 for run in runs))


def error_in(run, name):
    """The 95th percentile of a run in a bin, in mm."""
    return run.metrics.number("bins", name, "interior_mm", "p95")


def chart_of(runs, bins):
    """The bars; None if nothing was measured."""
    highest = max((error_in(run, name) or 0 for name in bins for run in runs), default=0)
    if highest <= 0:
        return None
    chart = BarChart([])
    group_px = chart.width / len(bins)
    bars_px = (BAR_PX + GAP_PX) * len(runs) - GAP_PX
    for i, name in enumerate(bins):
        left = group_px * i + (group_px - bars_px) / 2
        bars = [Bar(run.name, left + k * (BAR_PX + GAP_PX), chart.height * (error_in(run, name) or 0) / highest, error_in(run, name))
                for k, run in enumerate(runs)]
        chart.groups.append((name, left + bars_px / 2, bars))
    return chart
