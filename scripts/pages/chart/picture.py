# SPDX-License-Identifier: Apache-2.0
"""Pictures made of panels, with matplotlib. Positions are pixels of the picture, y down, unless they are said to be values of the axes."""
import io
import logging
import math
import re
from dataclasses import dataclass

import matplotlib
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from pages.chart.analysis import spread_apart

# Text stays text; the same numbers give the same file.
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "handcast", "axes.unicode_minus": False, "font.family": "sans-serif",
                            "font.sans-serif": ["Noto Sans", "Segoe UI", "Helvetica Neue", "Arial", "DejaVu Sans"]})
# It says which of these fonts are not installed here; a browser looks for them on its own computer.
logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)

DOTS_PER_INCH = 72  # so that points are pixels
NOT_OF_XML = re.compile("[\x00-\x1f\x7f-\x9f\ufffe\uffff]")


@dataclass(frozen=True)
class Area:
    """A rectangle of the picture."""
    left: float
    top: float
    right: float
    bottom: float


@dataclass(frozen=True)
class Range:
    """The range of an axis. The first value of a logarithmic one is greater than 0."""
    low: float = 0
    high: float = 1
    is_log: bool = False

    def share(self, value):
        """The place of a value on the axis: 0 at low, 1 at high."""
        if self.is_log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def tics(self, count=6):
        """Values at 1, 2, 5, 10, ... of a logarithmic range, or about `count` round values of a linear one."""
        if self.is_log:
            powers = range(math.floor(math.log10(self.low)), math.floor(math.log10(self.high)) + 1)
            tics = (digit * 10.0**power for power in powers for digit in (1, 2, 5))
            return [tic for tic in tics if self.low * 0.999 <= tic <= self.high * 1.001]
        rough = (self.high - self.low) / count
        decade = 10.0**math.floor(math.log10(rough))
        step = decade * next(factor for factor, limit in ((1, 1.5), (2, 3.5), (5, 7.5), (10, math.inf)) if rough < limit * decade)
        first, last = math.ceil(self.low / step - 1e-6), math.floor(self.high / step + 1e-6)
        return [i * step for i in range(first, last + 1)]


def range_of(values, is_log):
    """A range that holds all values with a margin. A linear one begins at 0."""
    if not values:
        return Range(1, 10, True) if is_log else Range()
    if is_log:
        return Range(0.85 * min(values), 1.18 * max(values), True)
    return Range(0, 1.06 * max(values) if max(values) > 0 else 1)


@dataclass(frozen=True)
class Label:
    """A text that names a point."""
    point: tuple  # in values of the axes
    words: str
    colour: str = "ink"
    bold: bool = False


class Picture:
    """A picture in the colours of one colour scheme of palette.py."""

    def __init__(self, width_px, height_px, colours):
        self.width_px, self.height_px, self.colours = width_px, height_px, colours
        inches = (width_px / DOTS_PER_INCH, height_px / DOTS_PER_INCH)
        self.figure = Figure(inches, DOTS_PER_INCH, facecolor=colours["panel"])

    def place(self, x_px, y_px):
        """A place as matplotlib has it: shares of the picture, y up."""
        return x_px / self.width_px, 1 - y_px / self.height_px

    def text(self, x_px, y_px, words, colour="ink", align="left", size=13, bold=False):
        """Writes a text, vertically centred."""
        self.figure.text(*self.place(x_px, y_px), NOT_OF_XML.sub(" ", words), color=self.colours[colour], ha=align,
                         va="center_baseline", fontsize=size, fontweight="semibold" if bold else "normal", parse_math=False)

    def line(self, points_px, colour):
        """Draws a line from point to point, behind everything else."""
        xs, ys = zip(*(self.place(*point) for point in points_px))
        self.figure.add_artist(Line2D(xs, ys, color=self.colours[colour], linewidth=1, zorder=-1))

    def svg(self, title):
        """The bytes of the picture."""
        content = io.BytesIO()
        self.figure.savefig(content, format="svg", facecolor=self.colours["panel"], metadata={"Title": title, "Date": None})
        return content.getvalue()


class Panel:
    """Linear or logarithmic axes in an area of a picture."""

    def __init__(self, picture, area, x, y):
        self.picture, self.area, self.x, self.y = picture, area, x, y
        left, bottom = picture.place(area.left, area.bottom)
        right, top = picture.place(area.right, area.top)
        self.axes = picture.figure.add_axes((left, bottom, right - left, top - bottom), facecolor="none", xlim=(x.low, x.high),
                                            ylim=(y.low, y.high), xscale="log" if x.is_log else "linear",
                                            yscale="log" if y.is_log else "linear")
        self.set_tics("x", x.tics())
        self.set_tics("y", y.tics())
        line = picture.colours["line"]
        self.axes.set_axisbelow(True)
        self.axes.grid(color=line, linewidth=0.7)
        self.axes.tick_params(length=0, labelsize=12, labelcolor=picture.colours["quiet"], pad=5)
        self.axes.spines[["top", "right"]].set_visible(False)
        self.axes.spines[["left", "bottom"]].set_color(line)

    def set_tics(self, axis, values, words="{:.6g}".format):
        """Replaces the tics of axis "x" or "y". `words`: the text of a value."""
        ticked = getattr(self.axes, f"{axis}axis")
        ticked.set_major_locator(FixedLocator(values))
        ticked.set_minor_locator(NullLocator())
        ticked.set_major_formatter(FuncFormatter(lambda value, _: words(value)))

    def title(self, words, x_px, y_px):
        """Writes what the panel shows, at a place beside the upper left corner of the axes."""
        self.picture.text(self.area.left + x_px, self.area.top + y_px, words, "ink", "left", 15, True)

    def name_x(self, words, below_px=36):
        """Writes a title below the axes."""
        self.picture.text((self.area.left + self.area.right) / 2, self.area.bottom + below_px, words, "quiet", "center", 12)

    def name_y(self, words):
        """Writes a title above the axes."""
        self.picture.text(self.area.left - 34, self.area.top - 16, words, "quiet", "left", 12)

    def place_px(self, point):
        """The position of a point given in values of the axes."""
        return (self.area.left + self.x.share(point[0]) * (self.area.right - self.area.left),
                self.area.bottom - self.y.share(point[1]) * (self.area.bottom - self.area.top))

    def band(self, begin, end, colour):
        """Fills the panel between two values of the x axis."""
        self.axes.axvspan(max(begin, self.x.low), min(end, self.x.high), color=self.picture.colours[colour], linewidth=0, zorder=0)

    def line(self, points, colour, width=2, dots=0, dashes=None):
        """Draws a line through points in values of the axes, with dots of a diameter in px."""
        self.axes.plot(*zip(*points), color=self.picture.colours[colour], linewidth=width, marker="o", markersize=dots, markeredgewidth=0,
                       linestyle=(0, dashes) if dashes else "-", clip_on=False, zorder=3)

    def dot(self, point, colour, size):
        """Draws a dot of a diameter in px, with a rim by which touching dots are told apart."""
        colours = self.picture.colours
        self.axes.plot(*point, "o", color=colours[colour], markersize=size, markeredgecolor=colours["panel"], markeredgewidth=1,
                       clip_on=False, zorder=4)

    def circle(self, point, colour):
        """Draws an open circle."""
        colours = self.picture.colours
        self.axes.plot(*point, "o", markersize=10, markerfacecolor=colours["panel"], markeredgecolor=colours[colour], markeredgewidth=2,
                       clip_on=False, zorder=5)

    def label_beside(self, labels, gap_px=17):
        """Writes labels in a column to the right of the panel, at least `gap_px` apart, with a line from each to its point."""
        places_px = [self.place_px(label.point) for label in labels]
        heights_px = spread_apart([y for _, y in places_px], gap_px, self.area.top + 4, self.area.bottom - 4)
        elbow_px, words_px = self.area.right + 12, self.area.right + 30
        for label, (x, y), height_px in zip(labels, places_px, heights_px):
            self.picture.line([(x + 6, y), (elbow_px, y), (words_px - 4, height_px)], "line")
            self.picture.text(words_px, height_px, label.words, label.colour, "left", 12, label.bold)
