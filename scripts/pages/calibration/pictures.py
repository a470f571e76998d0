# SPDX-License-Identifier: Apache-2.0
"""The pictures of a calibration, from the numbers that services/tools/calibrate writes.

    dots        size_px (width and height of an image), right_px, down_px
    bars        rms_px, is_left_out (1: the view took no part in the fit)
    depths      grid (columns, rows), depth_m, error_px [depth][row][column]
    gamma       level, share (measured); curve_level, fitted, set (curves): all 0 to 1
    histograms  background, hand, tips (how often each grey value 0 to 255 was seen), threshold
    places      right_mm, down_mm, far_m, light_mm, space_mm: a table, the first row is the middle of the volume
"""
from dataclasses import dataclass

from matplotlib.colors import LinearSegmentedColormap

from pages import palette
from pages.chart.picture import Area, Panel, Picture, Range, range_of
from pages.document import data_url
from pages.files import Problem

WIDTH_PX = 448
PLACES = (("right_mm", "right, mm", 0), ("down_mm", "down, mm", 0), ("far_m", "far, m", 2), ("light_mm", "light, ± mm", 1),
          ("space_mm", "space, ± mm", 1))


@dataclass
class Figure:
    """A picture in both colour schemes, or a table, and its caption."""
    caption: str
    light_url: str = ""
    dark_url: str = ""
    width_px: int = 0
    columns: tuple = ()  # headings
    rows: tuple = ()     # names and texts


def frame(panel):
    """Draws the border of an image, and no axes."""
    panel.set_tics("x", [])
    panel.set_tics("y", [])
    panel.axes.spines[:].set_visible(True)
    panel.axes.spines[:].set_color(panel.picture.colours["quiet"])


def draw_dots(numbers, colours):
    """Dots in an image."""
    width, height = numbers["size_px"]
    picture = Picture(WIDTH_PX, round(2 + (WIDTH_PX - 2) * height / width), colours)
    panel = Panel(picture, Area(1, 1, WIDTH_PX - 1, picture.height_px - 1), Range(-0.5, width - 0.5), Range(-0.5, height - 0.5))
    panel.axes.invert_yaxis()
    frame(panel)
    panel.axes.plot(numbers["right_px"], numbers["down_px"], "o", color=colours["ours"], markersize=3.4, markeredgewidth=0, alpha=0.75)
    return picture


def draw_bars(numbers, colours):
    """Numbered bars; those that were left out have another colour."""
    errors, left_out = numbers["rms_px"], numbers["is_left_out"]
    picture = Picture(WIDTH_PX, 236, colours)
    panel = Panel(picture, Area(44, 44, WIDTH_PX - 8, 200), Range(0.3, len(errors) + 0.7), range_of(errors, False))
    panel.set_tics("y", panel.y.tics(4))
    panel.set_tics("x", [number for number in range(1, len(errors) + 1) if len(errors) <= 20 or number % 5 == 0])
    panel.axes.grid(axis="x", visible=False)
    panel.axes.bar(range(1, len(errors) + 1), errors, width=0.74, color=[colours["cascade" if out else "ours"] for out in left_out], zorder=2)
    picture.text(10, 18, "root mean square, px", "quiet", "left", 12)
    if any(left_out):
        picture.text(WIDTH_PX - 8, 18, "left out", "cascade", "right", 12, True)
    return picture


def draw_depths(numbers, colours):
    """The errors over the camera's image, one map for each depth. The darkest colour is the largest error of all."""
    columns, rows = map(int, numbers["grid"])
    depths, errors, cells = numbers["depth_m"], numbers["error_px"], columns * rows
    map_px, gap_px, top_px, scale_px = 260, 18, 30, 64
    height_px = round(map_px * rows / columns)
    picture = Picture(round(len(depths) * (map_px + gap_px) + scale_px), top_px + height_px + 8, colours)
    shades = LinearSegmentedColormap.from_list("errors", [colours["panel"], colours["ours"]])
    largest = max(errors, default=0) or 1
    for i, depth in enumerate(depths):
        left_px, here = 1 + i * (map_px + gap_px), errors[i * cells:(i + 1) * cells]
        panel = Panel(picture, Area(left_px, top_px, left_px + map_px, top_px + height_px), Range(0, columns), Range(0, rows))
        frame(panel)
        grid = [here[row * columns:(row + 1) * columns] for row in range(rows)]
        image = panel.axes.imshow(grid, cmap=shades, vmin=0, vmax=largest, extent=(0, columns, rows, 0), aspect="auto", zorder=1)
        panel.axes.set_ylim(rows, 0)
        picture.text(left_px, 14, f"{depth:.2f} m: up to {max(here):.1f} px", "ink", "left", 12, True)
    left_px = len(depths) * (map_px + gap_px)
    low, high = picture.place(left_px, top_px + height_px), picture.place(left_px + 12, top_px)
    scale = picture.figure.add_axes((*low, high[0] - low[0], high[1] - low[1]))
    picture.figure.colorbar(image, cax=scale).outline.set_edgecolor(colours["quiet"])
    scale.tick_params(length=0, labelsize=11, labelcolor=colours["quiet"])
    picture.text(left_px, 14, "px", "quiet", "left", 12)
    return picture


def draw_gamma(numbers, colours):
    """The light by the level: measured, fitted, and by the rig's setting."""
    picture = Picture(WIDTH_PX, 356, colours)
    panel = Panel(picture, Area(52, 44, WIDTH_PX - 12, 308), Range(0, 255), Range(0, 1.04))
    panel.set_tics("x", [0, 64, 128, 192, 255])
    panel.set_tics("y", [0, 0.25, 0.5, 0.75, 1], lambda share: f"{100 * share:.0f} %")
    levels = [255 * level for level in numbers["curve_level"]]
    panel.line(list(zip(levels, numbers["set"])), "quiet", 1.6, dashes=(4, 3))
    panel.line(list(zip(levels, numbers["fitted"])), "ink", 1.6)
    panel.axes.plot([255 * level for level in numbers["level"]], numbers["share"], "o", color=colours["ours"], markersize=5,
                    markeredgecolor=colours["panel"], markeredgewidth=0.7, zorder=5)
    picture.text(10, 18, "light", "quiet", "left", 12)
    for x_px, words, colour in ((WIDTH_PX - 190, "measured", "ours"), (WIDTH_PX - 124, "fitted", "ink"), (WIDTH_PX - 12, "rig's setting", "quiet")):
        picture.text(x_px, 18, words, colour, "right", 12, True)
    panel.name_x("level", 34)
    return picture


def draw_histograms(numbers, colours):
    """How often each grey value was seen, each curve scaled to its most frequent value, and the threshold."""
    width_px = 720
    picture = Picture(width_px, 236, colours)
    panel = Panel(picture, Area(12, 44, width_px - 12, 190), Range(0, 255), Range(0, 1.05))
    panel.set_tics("x", [0, 32, 64, 96, 128, 160, 192, 224, 255])
    panel.set_tics("y", [])
    for x_px, name, words, colour in ((12, "background", "background", "baseline"), (106, "hand", "hand", "cascade"),
                                      (152, "tips", "its finger tips", "ours")):
        most = max(numbers[name], default=0) or 1
        shares = [count / most for count in numbers[name]]
        panel.axes.fill_between(range(len(shares)), shares, step="mid", color=colours[colour], alpha=0.55, linewidth=0, zorder=2)
        panel.axes.step(range(len(shares)), shares, where="mid", color=colours[colour], linewidth=1.2, zorder=3)
        picture.text(x_px, 18, words, colour, "left", 12, True)
    threshold = numbers["threshold"][0]
    panel.line([(threshold, 0), (threshold, 1.05)], "ink", 1.2, dashes=(4, 3))
    picture.text(panel.place_px((threshold, 0))[0] + 6, 54, f"threshold {threshold:.0f}", "ink", "left", 12)
    panel.name_x("grey value", 34)
    return picture


DRAWN = {"dots": draw_dots, "bars": draw_bars, "depths": draw_depths, "gamma": draw_gamma, "histograms": draw_histograms}


def table_of(caption, numbers):
    """The errors at places of the volume."""
    rows = [("corner" if row else "middle", [f"{round(value, digits) + 0.0:.{digits}f}" for value, (_, _, digits) in zip(values, PLACES)])
            for row, values in enumerate(zip(*(numbers[name] for name, _, _ in PLACES)))]
    return Figure(caption, columns=tuple(heading for _, heading, _ in PLACES), rows=tuple(rows))


def drawn(kind, caption, numbers):
    """The figure of a picture's data. Raises Problem if it lacks something."""
    try:
        if kind == "places":
            return table_of(caption, numbers)
        if kind == "dots":
            caption += " The frame is the image, {:.0f} x {:.0f} px.".format(*numbers["size_px"])
        light, dark = (DRAWN[kind](numbers, colours) for colours in (palette.LIGHT, palette.DARK))
    except (KeyError, IndexError, ValueError) as error:
        raise Problem(f"a picture of the kind '{kind}' lacks something ({error}); measure its step again") from None
    urls = (data_url("image/svg+xml", picture.svg(caption)) for picture in (light, dark))
    return Figure(caption, *urls, width_px=light.width_px)
