# SPDX-License-Identifier: Apache-2.0
"""Chart B: error against stress, a panel for each stress, with the points at which the error doubles."""
from dataclasses import dataclass

from pages.chart.chart import Chart
from pages.chart.picture import Area, Label, Panel, Picture, range_of
from pages.chart.stress import STRESSES, Stress, lines_of
from pages.chart.table import Column, NumberTable

COLUMNS = 3
PANEL_WIDTH_PX, PANEL_HEIGHT_PX = 326, 280
BREAKDOWN_LABEL_PX = 27  # width

READING = (
    "One setting at a time is made worse; the others have their defaults. Points without light count as 20 mm. The open circle is the "
    "breakdown point, at which the harm is twice that of the mildest stress.")


@dataclass
class Test:
    """The methods under one stress."""
    stress: Stress
    lines: list

    def line_of(self, method):
        """The line of a method; None if there is none."""
        return next((line for line in self.lines if line.method == method), None)

    def values(self, axis):
        """All x (0) or y (1) of the points."""
        return [point[axis] for line in self.lines for point in line.points]

    def levels(self):
        """All levels at which any method has a point, with the x of the first such method."""
        levels = {}
        for line in self.lines:
            for level, (x, _) in zip(line.levels, line.points):
                levels.setdefault(level, x)
        return sorted(levels.items())


def short_label(method):
    """The name of a method in a small panel."""
    return {"paper": "paper", "paper_at_our_speed": "paper, fast"}.get(method.variant, method.label)


def mark_breakdown(panel, line):
    """The circle with its number: below the line on the right for ours, else above it on the left, but inside the panel."""
    if not line.breakdown:
        return
    panel.circle(line.breakdown, line.method.colour)
    x, y = panel.place_px(line.breakdown)
    number = f"{line.breakdown[0]:.3g}"
    if line.method.is_ours:
        panel.picture.text(x + 9, y + 11, number, line.method.colour, "left", 11)
    else:
        panel.picture.text(max(x - 9, panel.area.left + BREAKDOWN_LABEL_PX), y - 15, number, line.method.colour, "right", 11)


def harm_range(tests, like):
    """Panels with the same metric have the same y axis."""
    harms = [y for test in tests if test.stress.harm_title == like.stress.harm_title for y in test.values(1)]
    return range_of(harms, min(harms) > 0)


def draw_test(picture, test, y, left_px, top_px):
    """The panel of one stress."""
    x = range_of(test.values(0), False)
    area = Area(left_px + 40, top_px + 58, left_px + PANEL_WIDTH_PX - 98, top_px + PANEL_HEIGHT_PX - 46)
    panel = Panel(picture, area, x, y)
    panel.set_tics("x", x.tics(4))
    panel.title(test.stress.title, -34, -38)
    panel.name_y(test.stress.harm_title)
    panel.name_x(test.stress.unit)
    for line in test.lines:
        panel.line(line.points, line.method.colour, 2.5 if line.method.is_ours else 1.8, dots=4.5)
        mark_breakdown(panel, line)
    panel.label_beside([Label(line.points[-1], short_label(line.method), line.method.colour, line.method.is_ours)
                        for line in test.lines], 15)


def draw(tests, colours):
    """The picture: a panel for each stress."""
    rows = -(-len(tests) // COLUMNS)
    picture = Picture(COLUMNS * PANEL_WIDTH_PX, rows * PANEL_HEIGHT_PX, colours)
    for i, test in enumerate(tests):
        draw_test(picture, test, harm_range(tests, test), PANEL_WIDTH_PX * (i % COLUMNS), PANEL_HEIGHT_PX * (i // COLUMNS))
    return picture


def methods_of(tests):
    """All methods, in the order of the lines."""
    return list(dict.fromkeys(line.method for test in tests for line in test.lines))


def columns_of(methods, digits):
    """A column for each method."""
    return [Column(method.variant, short_label(method), digits) for method in methods]


def breakdowns_of(tests, methods):
    """The numbers of the circles."""
    table = NumberTable(
        "chart_b_breakdown",
        "The stress at which the harm is twice that of the mildest stress of the sweep. A dash: not reached within the sweep.",
        [Column("stress", "breaks down at"), Column("unit", "unit"), Column("up_to", "swept up to", 1), *columns_of(methods, 1)])
    for test in tests:
        breakdowns = [line and line.breakdown and line.breakdown[0] for line in map(test.line_of, methods)]
        table.rows.append([test.stress.title, test.stress.unit, max(test.values(0)), *breakdowns])
    return table


def numbers_of(tests, methods):
    """The numbers of the points."""
    table = NumberTable(
        "chart_b", "Means over motions and seeds. Simulated: the same on all machines.",
        [Column("stress", "stress"), Column("level", "level"), Column("unit", "unit"), Column("harm", "harm"), *columns_of(methods, 2)])
    for test in tests:
        for level, x in test.levels():
            harms = [line and line.harm_at(level) for line in map(test.line_of, methods)]
            table.rows.append([test.stress.title, x, test.stress.unit, test.stress.harm_title, *harms])
    return table


def chart_b(results):
    """The chart of the results."""
    chart = Chart("chart_b", "B. Where methods fail", READING)
    tests = [Test(stress, lines) for stress in STRESSES if (lines := lines_of(results, stress))]
    if not tests:
        chart.lacking = "needs runs in which a single setting is made worse: sweep config/sweeps/stress.toml"
        return chart
    methods = methods_of(tests)
    chart.draw = lambda colours: draw(tests, colours)
    chart.tables = [breakdowns_of(tests, methods), numbers_of(tests, methods)]
    return chart
