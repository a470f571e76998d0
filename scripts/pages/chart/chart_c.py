# SPDX-License-Identifier: Apache-2.0
"""Chart C: error against degrees of freedom, and against time."""
from dataclasses import dataclass

from pages.chart.chart import Chart
from pages.chart.ladder import ladder_of, name_of_speed
from pages.chart.methods import RUNGS
from pages.chart.picture import Area, Label, Panel, Picture, Range, range_of
from pages.chart.table import Column, NumberTable

WIDTH_PX, HEIGHT_PX = 980, 400
ERROR = "interior error, 95th percentile, mm"

READING = (
    "Each rung of the ladder, the least first: the gain and the cost of more degrees of freedom. The last one, with late registration, is "
    "handcast.")


@dataclass
class Series:
    """The rungs at one speed, in their order."""
    speed: float
    colour: str
    rungs: list


def series_of(ladder):
    """The speeds at which there is any rung."""
    series = []
    for speed in ladder.speeds:
        standings = {standing.method.variant: standing for standing in ladder.at(speed)}
        rungs = [standings[rung.variant] for rung in RUNGS if rung.variant in standings]
        if rungs:
            series.append(Series(speed, "fast" if series else "ours", rungs))
    return series


def name_rungs(panel):
    """Degrees of freedom and names below the axis."""
    panel.set_tics("x", range(len(RUNGS)), lambda _: "")
    for i, rung in enumerate(RUNGS):
        x_px = panel.place_px((i, panel.y.low))[0]
        panel.picture.text(x_px, panel.area.bottom + 16, f"{rung.freedoms}", "ink", "center", 12)
        panel.picture.text(x_px, panel.area.bottom + 33, rung.label, "quiet", "center", 11)


def draw_freedoms(picture, series, y):
    """The error over the rungs."""
    x = Range(-0.4, len(RUNGS) - 0.6)
    panel = Panel(picture, Area(44, 62, 470, HEIGHT_PX - 62), x, y)
    panel.title("by degrees of freedom", -34, -38)
    panel.name_y(ERROR)
    panel.name_x("degrees of freedom per hand", 52)
    name_rungs(panel)
    labels = []
    for each in series:
        points = [(RUNGS.index(standing.method), standing.p95_mm) for standing in each.rungs]
        panel.line(points, each.colour, dots=6.5)
        labels.append(Label(points[-1], name_of_speed(each.speed), each.colour))
    panel.label_beside(labels)


def draw_times(picture, series, y):
    """The error over the time of a frame. Only the rungs of the last series have labels: its points are the furthest apart."""
    times_us = [standing.frame_us for each in series for standing in each.rungs if standing.frame_us]
    if not times_us:
        return
    x = Range(0.93 * min(times_us), 1.05 * max(times_us))
    panel = Panel(picture, Area(656, 62, 866, HEIGHT_PX - 62), x, y)
    panel.title("by time", -34, -38)
    panel.name_y(ERROR)
    panel.set_tics("x", x.tics(3))
    panel.name_x("median frame time on one core, µs")
    labels = []
    for each in series:
        timed = [(standing.method.label, (standing.frame_us, standing.p95_mm)) for standing in each.rungs if standing.frame_us]
        if timed:
            panel.line([point for _, point in timed], each.colour, dots=6.5)
        labels += [Label(point, label, each.colour) for label, point in timed] if each is series[-1] else []
    panel.label_beside(labels, 15)


def draw(series, colours):
    """The picture: both panels with one y axis."""
    y = range_of([standing.p95_mm for each in series for standing in each.rungs], True)
    picture = Picture(WIDTH_PX, HEIGHT_PX, colours)
    draw_freedoms(picture, series, y)
    draw_times(picture, series, y)
    return picture


def table_of(series, timed_alone):
    """The numbers: a row for each rung and speed."""
    how = ("measured with one run at a time." if timed_alone else
           "measured with several runs at a time; sweep config/sweeps/times.toml with -j 1 for better ones.")
    table = NumberTable(
        "chart_c",
        f"Errors are simulated and the same on all machines. Columns in italics are times of the machine that ran the sweep, {how}",
        [Column("speed", "speed"), Column("rung", "rung"), Column("degrees_of_freedom", "degrees of freedom", 0),
         Column("interior_mm_mean", "interior mean, mm"), Column("interior_mm_p95", "p95, mm"), Column("jitter_px", "jitter, px"),
         Column("frame_us_p50", "frame, µs p50", 0, True)])
    for each in series:
        for standing in each.rungs:
            table.rows.append([name_of_speed(each.speed), standing.method.label, standing.method.freedoms,
                               standing.mean_mm, standing.p95_mm, standing.jitter_px, standing.frame_us])
    return table


def chart_c(results):
    """The chart of the results."""
    chart = Chart("chart_c", "C. No more than needed", READING)
    ladder = ladder_of(results)
    series = series_of(ladder)
    if not series:
        chart.lacking = ("needs runs with the rungs hold, predict, shift, similarity, fingers, landmarks and register as variants: sweep "
                         "config/sweeps/ladder.toml")
        return chart
    chart.draw = lambda colours: draw(series, colours)
    chart.tables = [table_of(series, ladder.timed_alone)]
    return chart
