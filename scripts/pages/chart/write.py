# SPDX-License-Identifier: Apache-2.0
"""handcast chart: charts.html, and the SVG and the CSV files of each chart that can be drawn."""
import pathlib
from dataclasses import dataclass

from pages import palette
from pages.chart.chart import Chart
from pages.chart.chart_a import chart_a
from pages.chart.chart_b import chart_b
from pages.chart.chart_b_faults import chart_b_faults
from pages.chart.chart_c import chart_c
from pages.chart.chart_hardware import chart_hardware
from pages.chart.results import read_results
from pages.document import data_url, now, page_of, this_machine
from pages.files import Problem, write_whole

DONE = 0


@dataclass
class Drawing:
    """A chart with its SVG in both colour schemes; None if it was not drawn."""
    chart: Chart
    light: bytes = None
    dark: bytes = None

    @property
    def light_url(self):
        """The address of the light picture, embedded in the page."""
        return data_url("image/svg+xml", self.light)

    @property
    def dark_url(self):
        """The same of the dark one."""
        return data_url("image/svg+xml", self.dark)


def drawing_of(chart):
    """The drawing of a chart."""
    if not chart.draw:
        return Drawing(chart)
    return Drawing(chart, *(chart.draw(colours).svg(chart.title) for colours in (palette.LIGHT, palette.DARK)))


def source_fact(source):
    """A sweep, and how many of its runs there are."""
    failed = f", {source.failed} failed" if source.failed else ""
    return f"sweep {source.plan}", f"{source.scored} of {source.planned} runs{failed}"


def page(results, drawings, title):
    """The bytes of charts.html."""
    facts = [*map(source_fact, results.sources), ("drawn on", this_machine()), ("at", now())]
    return page_of("charts.html", title, facts, drawings=drawings)


def write_drawing(folder, drawing):
    """Writes the light picture, and the numbers."""
    write_whole(folder / f"{drawing.chart.name}.svg", drawing.light)
    for table in drawing.chart.tables:
        write_whole(folder / f"{table.name}.csv", table.csv())


def make_folder(folder):
    """Makes a folder and those above it. Raises Problem."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Problem(f"{folder}: the folder cannot be made: {error.strerror}", may_pass=True) from None


def run(values, complain):
    """The verb. Charts that cannot be drawn are named; if there is no other, that is an error."""
    results = read_results(values.results)
    charts = [make(results) for make in (chart_a, chart_b, chart_b_faults, chart_c, chart_hardware)]
    lacking = [f"{chart.name} {chart.lacking}" for chart in charts if chart.lacking]
    if len(lacking) == len(charts):
        raise Problem(f"no chart can be drawn from these results: {'; '.join(lacking)}")
    drawings = list(map(drawing_of, charts))
    folder = pathlib.Path(values.out)
    make_folder(folder)
    for drawing in drawings:
        if drawing.light:
            write_drawing(folder, drawing)
    write_whole(folder / "charts.html", page(results, drawings, values.title))
    for sentence in lacking:
        complain(DONE, sentence)
    print(folder / "charts.html")
    return DONE
