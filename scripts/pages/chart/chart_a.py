# SPDX-License-Identifier: Apache-2.0
"""Chart A: speed against accuracy."""
from dataclasses import dataclass

from pages.chart.analysis import pareto_front
from pages.chart.chart import Chart
from pages.chart.ladder import ladder_of, name_of_speed
from pages.chart.picture import Area, Label, Panel, Picture, Range, range_of
from pages.chart.table import Column, NumberTable

# Just noticeable delay of the light, without and with the fill (paper, "Just Noticeable Difference").
JND_EDGES_MS, JND_FILLED_MS = 3.08, 6.62

WIDTH_PX, HEIGHT_PX = 1090, 440
FROM_MS = 2  # less than the delay of any camera and projector

READING = (
    "Further left is faster, further down is more accurate: the error is the one that 95 % of the points of the skin do not exceed; a point "
    "without light counts as 20 mm. The dashed line joins the methods that no other method beats in both. What is \"with\" a detector is "
    "handcast. In the shaded bands the delay is not noticed: up to 3.08 ms without the fill, when the edges of the light are visible, and "
    "up to 6.62 ms with it.")
CAPTION = (
    "Means over the motions and seeds of the sweep. The error is that at the middle of a frame's light. The motion-to-photon time of the "
    "paper has its published software time; those of the others have the measured time of a frame on one core, which is that of handcast "
    "for ideal landmarks, the paper at our speed and real detectors. Simulated figures are the same on all machines; columns in italics "
    "depend on the machine that ran the sweep.")


@dataclass
class Field:
    """The methods at one speed, and the indices of those that no other one beats."""
    speed: float
    standings: list
    front: list


def field_of(ladder, speed):
    """The methods with both figures. "ideal" uses the truth: it cannot be built, and is not on the front."""
    standings = [standing for standing in ladder.at(speed) if standing.photon_ms is not None]
    buildable = [(1e9, 1e9) if standing.method.variant == "ideal" else standing.point for standing in standings]
    return Field(speed, standings, pareto_front(buildable))


def stair_of(field):
    """The front as a staircase from its first point to its last."""
    stair = []
    for i in field.front:
        x, y = field.standings[i].point
        stair += [(x, stair[-1][1])] if stair else []
        stair.append((x, y))
    return stair


def label_of(standing):
    """The name of a method, with the age of what its detector finds."""
    if not standing.method.detects or standing.landmarks_ms is None:
        return standing.method.label
    return f"{standing.method.label}, {standing.landmarks_ms:.0f} ms old"


def draw_bands(panel):
    """The delays that are not noticed."""
    panel.band(0, JND_EDGES_MS, "near")
    panel.band(JND_EDGES_MS, JND_FILLED_MS, "far")
    for at_ms, words in ((JND_EDGES_MS, "3.08"), (JND_FILLED_MS, "6.62, filled")):
        panel.picture.text(panel.place_px((at_ms, 1))[0] - 5, panel.area.top + 10, words, "quiet", "right", 11)


def draw_field(picture, field, left_px, x, y):
    """The panel of one speed."""
    panel = Panel(picture, Area(left_px, 62, left_px + 272, HEIGHT_PX - 52), x, y)
    panel.title(name_of_speed(field.speed), -34, -38)
    panel.name_y("interior error, 95th percentile, mm")
    panel.name_x("motion to photon, ms")
    draw_bands(panel)
    if field.front:
        panel.line(stair_of(field), "ours", 2, dashes=(3, 2))
    labels = []
    for standing in field.standings:
        method, is_rung = standing.method, standing.method.is_rung
        panel.dot(standing.point, method.colour, 12 if method.is_ours else 7 if is_rung else 9)
        words = f"{label_of(standing)}\u2002{standing.p95_mm:.1f}"
        labels.append(Label(standing.point, words, "quiet" if is_rung else "ink", method.is_ours))
    panel.label_beside(labels)


def draw(fields, colours):
    """The picture: a panel for each speed."""
    points = [standing.point for field in fields for standing in field.standings]
    x = Range(FROM_MS, range_of([JND_FILLED_MS, *(x + 0.4 for x, _ in points)], False).high)
    y = range_of([y for _, y in points], True)
    picture = Picture(WIDTH_PX, HEIGHT_PX, colours)
    for i, field in enumerate(fields):
        draw_field(picture, field, 44 + 530 * i, x, y)
    return picture


def table_of(fields, timed_alone):
    """The numbers: a row for each method and speed."""
    table = NumberTable("chart_a", CAPTION, [
        Column("speed", "speed"), Column("method", "method"), Column("back_end", "back end"),
        Column("motion_to_photon_ms", "motion to photon, ms", 2, timed_alone), Column("interior_mm_p95", "interior p95, mm"),
        Column("interior_mm_mean", "mean, mm"), Column("coverage", "coverage", 3), Column("spill", "spill", 3),
        Column("jitter_px", "landmark jitter, px"), Column("landmarks_age_ms", "landmark age, ms", 1),
        Column("frame_us_p50", "frame, µs p50", 0, True), Column("on_front", "on the front"), Column("runs", "runs", 0)])
    for field in fields:
        for i, standing in enumerate(field.standings):
            table.rows.append([name_of_speed(field.speed), standing.method.label, "cpu", standing.photon_ms, standing.p95_mm,
                               standing.mean_mm, standing.coverage, standing.spill, standing.jitter_px, standing.landmarks_ms,
                               standing.frame_us, "yes" if i in field.front else "", standing.runs])
    return table


def chart_a(results):
    """The chart of the results."""
    chart = Chart("chart_a", "A. Speed against accuracy", READING)
    ladder = ladder_of(results)
    fields = [field_of(ladder, speed) for speed in ladder.speeds]
    if not any(field.standings for field in fields):
        chart.lacking = "needs drawn runs with the columns motion_to_photon_ms and interior_mm_p95: sweep config/sweeps/ladder.toml"
        return chart
    chart.draw = lambda colours: draw(fields, colours)
    chart.tables = [table_of(fields, ladder.timed_alone)]
    return chart
