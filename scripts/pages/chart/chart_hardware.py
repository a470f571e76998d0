# SPDX-License-Identifier: Apache-2.0
"""The chart "What hardware buys": the error with each camera and projector."""
from dataclasses import dataclass

from pages.chart.chart import Chart
from pages.chart.chart_b import short_label
from pages.chart.hardware import pairs_of
from pages.chart.ladder import name_of_speed
from pages.chart.picture import Area, Label, Panel, Picture, Range, range_of
from pages.chart.table import Column, NumberTable

WIDTH_PX, HEIGHT_PX = 1160, 420

READING = (
    "Each line is a camera, from the slowest to the fastest, each place on it a projector: devices that people own, and those of the paper "
    "(525 and 946 Hz). Further down is more accurate; a point without light counts as 20 mm. The numbers below the lines are those of the fastest camera.")
CAPTION = (
    "Means over motions that nothing was tuned on, and over seeds, in a careful installation (config/sweeps/hardware.toml). Simulated: "
    "the same on all machines.")


@dataclass
class Line:
    """A method with one camera at one speed, by ascending rate of the projector."""
    pairs: list

    @property
    def method(self):
        """The method."""
        return self.pairs[0].method

    @property
    def camera_hz(self):
        """The rate of the camera."""
        return self.pairs[0].camera_hz

    def points(self, projectors):
        """Places of projectors and errors."""
        return [(projectors.index(pair.projector), pair.mean_mm) for pair in self.pairs]


def lines_of(pairs, speed):
    """The lines of a panel, by camera, those of handcast last."""
    lines = {}
    for pair in pairs:
        if pair.speed == speed:
            lines.setdefault((pair.method.is_ours, pair.camera_hz), []).append(pair)
    return [Line(sorted(lines[key], key=lambda pair: pair.projector)) for key in sorted(lines)]


def name_projectors(panel, projectors):
    """Rates and lags below the axis."""
    panel.set_tics("x", range(len(projectors)), lambda _: "")
    for i, projector in enumerate(projectors):
        x_px = panel.place_px((i, panel.y.low))[0]
        panel.picture.text(x_px, panel.area.bottom + 17, f"{projector.rate_hz:g} Hz", "ink", "center", 13)
        panel.picture.text(x_px, panel.area.bottom + 34, f"{projector.lag_ms:g} ms", "quiet", "center", 11)


def draw_method(panel, lines, projectors):
    """The lines of a method: bold those of the slowest and the fastest camera, which have labels, fine those between. Ours has numbers
    below the fastest one. Returns the labels."""
    colour, labels = lines[0].method.colour, []
    for line in lines:
        points = line.points(projectors)
        is_outer = line in (lines[0], lines[-1])
        panel.line(points, colour, 2.5 if is_outer else 1, dots=7 if is_outer else 0)
        if is_outer:
            words = f"{short_label(line.method)}, {line.camera_hz} Hz camera\u2002{points[-1][1]:.1f}"
            labels.append(Label(points[-1], words, colour, line.method.is_ours))
    for point in lines[-1].points(projectors) if lines[0].method.is_ours else ():
        x_px, y_px = panel.place_px(point)
        panel.picture.text(x_px, y_px + 16, f"{point[1]:.1f}", colour, "center", 12, True)
    return labels


def draw_speed(picture, lines, projectors, speed, left_px, y):
    """The panel of one speed."""
    panel = Panel(picture, Area(left_px, 70, left_px + 300, HEIGHT_PX - 74), Range(-0.25, len(projectors) - 0.75), y)
    panel.title(name_of_speed(speed), -34, -44)
    panel.name_y("error of the light, mean, mm")
    panel.name_x("projector: its rate, and how late its light comes", 58)
    name_projectors(panel, projectors)
    labels = []
    for method in dict.fromkeys(line.method for line in lines):
        labels += draw_method(panel, [line for line in lines if line.method == method], projectors)
    panel.label_beside(labels)


def draw(pairs, colours):
    """The picture: a panel for each speed."""
    projectors = sorted({pair.projector for pair in pairs})
    speeds = sorted({pair.speed for pair in pairs})
    y = range_of([pair.mean_mm for pair in pairs], False)
    picture = Picture(WIDTH_PX, HEIGHT_PX, colours)
    for i, speed in enumerate(speeds):
        draw_speed(picture, lines_of(pairs, speed), projectors, speed, 44 + (WIDTH_PX // 2 + 6) * i, y)
    return picture


def table_of(pairs):
    """The numbers: a row for each pair."""
    table = NumberTable("hardware", CAPTION, [
        Column("speed", "speed"), Column("method", "method"), Column("camera_hz", "camera, Hz", 0), Column("projector", "projector"),
        Column("interior_mm_mean", "interior mean, mm"), Column("interior_mm_p95", "p95, mm"), Column("off_10mm", "dark or > 10 mm off", 3),
        Column("equivalent_latency_ms", "equivalent latency, ms", 1), Column("motion_to_photon_ms", "motion to photon, ms", 1),
        Column("runs", "runs", 0)])
    for pair in pairs:
        table.rows.append([name_of_speed(pair.speed), pair.method.label, pair.camera_hz, pair.projector.name, pair.mean_mm, pair.p95_mm,
                           pair.off_10mm, pair.latency_ms, pair.photon_ms, pair.runs])
    return table


def chart_hardware(results):
    """The chart of the results."""
    chart = Chart("hardware", "What hardware buys", READING)
    pairs = pairs_of(results)
    if not pairs:
        chart.lacking = "needs runs of cameras with projectors: sweep config/sweeps/hardware.toml"
        return chart
    chart.draw = lambda colours: draw(pairs, colours)
    chart.tables = [table_of(pairs)]
    return chart
