# SPDX-License-Identifier: Apache-2.0
"""Chart B, the failure atlas: a row for each failure of a rig."""
from dataclasses import dataclass

from pages.chart.chart import Chart
from pages.chart.faults import KIND_NAMES, LASTING, MOTION, PASSING, failures_of
from pages.chart.methods import COMPARED, method_of
from pages.chart.picture import Area, Panel, Picture, Range, range_of
from pages.chart.table import Column, NumberTable

WIDTH_PX, ROW_PX, NAMES_PX, DOTS_PX, TOP_PX, BELOW_PX = 1060, 24, 422, 700, 96, 34
COLUMN_PX, COLUMNS_PX = 95, DOTS_PX + 110  # the right edges of the figures on the right

DOT_SIZES = (6, 9, 12)  # of COMPARED: dots at one place are all seen

READING = (
    "The failures of a rig: how far its landmarks are off from each of them on, and the time until they are good again; of what lasts, the "
    "light.")
CAPTION = (
    "Worst error, recovery and time without light are of the landmarks, and the largest over the motions of the sweep. Recovery is the time "
    "from the end of the fault until the error stays for 100 ms within half the usual error of the same run without the fault. The other "
    "figures are of the whole run: means over the motions, and the largest number of fold-overs. Simulated: the same on all machines.")


@dataclass
class Block:
    """The failures of one kind. The dots show one metric, the columns on the right another."""
    title: str
    axis: str
    columns_title: str
    metric: str  # of Damage, shown by the dots
    kind: int
    failures: list = None

    @property
    def height_px(self):
        """The height in the picture."""
        return TOP_PX + ROW_PX * len(self.failures) + BELOW_PX


def blocks_of(failures):
    """The blocks that have any row."""
    error, lit = "interior error p95, mm", "hand lit, %"
    blocks = [Block("For a moment", "worst landmark error, mm", "recovery, ms (* the paper's is faster)", "worst_mm", PASSING),
              Block("For the whole run", error, lit, "p95_mm", LASTING),
              Block("Difficult motions, and a wave for comparison", error, lit, "p95_mm", MOTION)]
    for block in blocks:
        block.failures = [failure for failure in failures if failure.kind == block.kind]
    return [block for block in blocks if block.failures]


def words_of(failure, method):
    """The figure on the right."""
    damage = failure.damage[method.variant]
    if failure.kind != PASSING:
        return "–" if damage.coverage is None else f"{100 * damage.coverage:.1f}"
    star = "*" if method.is_ours and failure.paper_is_faster() else ""
    if damage.never_good:
        return "never" + star
    return ("–" if damage.recovery_ms is None else f"{damage.recovery_ms:.0f}") + star


def draw_row(panel, block, row, y_px):
    """One failure: its name, its dots, the smaller ones above the larger ones, and the figures on the right."""
    failure, picture = block.failures[row], panel.picture
    picture.text(NAMES_PX - 12, y_px, failure.name, "ink", "right", 12)
    picture.line([(NAMES_PX, y_px), (DOTS_PX, y_px)], "line")
    for i in reversed(range(len(COMPARED))):
        method = method_of(COMPARED[i])
        if method.variant not in failure.damage:
            continue
        value = getattr(failure.damage[method.variant], block.metric)
        if value and value > 0:
            panel.dot((value, len(block.failures) - row - 0.5), method.colour, DOT_SIZES[i])
        picture.text(COLUMNS_PX + COLUMN_PX * i, y_px, words_of(failure, method), method.colour, "right", 12, method.is_ours)


def draw_block(picture, block, top_px):
    """The rows of one kind of failure."""
    first_px, count = top_px + TOP_PX, len(block.failures)
    values = [getattr(damage, block.metric) for failure in block.failures for damage in failure.damage.values()]
    panel = Panel(picture, Area(NAMES_PX, first_px, DOTS_PX, first_px + ROW_PX * count),
                  range_of([value for value in values if value and value > 0], True), Range(0, count))
    panel.set_tics("y", [])
    panel.axes.spines[["left", "bottom"]].set_visible(False)
    picture.text(20, top_px + 24, block.title, "ink", "left", 15, True)
    picture.text(NAMES_PX, first_px - 34, block.axis, "quiet", "left", 12)
    picture.text(DOTS_PX + 300, first_px - 34, block.columns_title, "quiet", "right", 12)
    for i, variant in enumerate(COMPARED):
        picture.text(COLUMNS_PX + COLUMN_PX * i, first_px - 14, variant, method_of(variant).colour, "right", 12, True)
    for row in range(count):
        draw_row(panel, block, row, first_px + ROW_PX * (row + 0.5))


def draw(blocks, colours):
    """The picture: one block below the other."""
    picture = Picture(WIDTH_PX, sum(block.height_px for block in blocks), colours)
    top_px = 0
    for block in blocks:
        draw_block(picture, block, top_px)
        top_px += block.height_px
    return picture


def table_of(failures):
    """The numbers: a row for each failure and method."""
    table = NumberTable("chart_b_faults", CAPTION, [
        Column("failure", "failure"), Column("kind", "kind"), Column("method", "method"), Column("worst_mm", "worst, mm", 1),
        Column("recovery_ms", "recovery, ms", 0), Column("paper_faster", "the paper's recovers faster"),
        Column("dark_ms", "without light, ms", 0), Column("interior_mm_p95", "interior p95, mm"), Column("coverage", "coverage", 3),
        Column("spill", "spill", 3), Column("foldovers", "fold-overs", 0)])
    for failure in failures:
        for variant in (variant for variant in COMPARED if variant in failure.damage):
            damage = failure.damage[variant]
            table.rows.append([failure.name, KIND_NAMES[failure.kind], variant, damage.worst_mm,
                               "not within the run" if damage.never_good else damage.recovery_ms,
                               "yes" if variant == "handcast" and failure.paper_is_faster() else "", damage.dark_ms, damage.p95_mm,
                               damage.coverage, damage.spill, damage.foldovers])
    return table


def recovery_words(damage):
    """The recovery in a sentence."""
    return "does not within the run" if damage.never_good else f"{damage.recovery_ms or 0:.0f} ms"


def slower_than_paper(failures):
    """The failures of which the paper's cascade recovers faster than ours, in a sentence."""
    compared = [failure for failure in failures if failure.kind == PASSING and {"paper", "handcast"} <= failure.damage.keys()]
    slower = [failure for failure in compared if failure.paper_is_faster()]
    if not compared:
        return ""
    if not slower:
        return f" The paper's cascade recovers faster than ours in none of {len(compared)} failures."
    listed = "; ".join(f"{failure.name}: {recovery_words(failure.damage['paper'])}, ours {recovery_words(failure.damage['handcast'])}"
                       for failure in slower)
    return f" The paper's cascade recovers faster than ours in {len(slower)} of {len(compared)} failures ({listed})."


def chart_b_faults(results):
    """The chart of the results."""
    failures = failures_of(results)
    chart = Chart("chart_b_faults", "B. The failure atlas", READING + slower_than_paper(failures))
    if not failures:
        chart.lacking = "needs drawn runs with failures: sweep config/sweeps/failures.toml"
        return chart
    chart.draw = lambda colours: draw(blocks_of(failures), colours)
    chart.tables = [table_of(failures)]
    return chart
