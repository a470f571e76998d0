#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of a sweep as a table, or as sentences, into a document.

    results_table.py PART RESULTS.csv DOCUMENT.md [COMMAND [PEOPLE]]

PART is a table of scripts/results (comparison, unseen, levers, fidelity, causes, motions, fast, two_hands, jitter, first_seconds,
no_tracker), or a short form of one: summary (of unseen, for README.md), unseen_pairs, comparison_pairs or levers_summary (for
docs/results.md), or hardware or hardware_parts (for docs/lab/charts.md). It replaces what stands between the lines "<!-- PART: begin -->" and
"<!-- PART: end -->". COMMAND is named below the table as what has made it, and PEOPLE is the number of seeds that the protocol asks
for: a table of fewer says so. scripts/results and scripts/charts call this program.
"""

import sys

from tables import hardware
from tables.document import replaced, wrapped, write_whole
from tables.rows import PARTS, footer, table, variants_of
from tables.runs import Runs, die, is_count
from tables.summaries import SUMMARIES
from tables.verdicts import verdict


def runs_of(part, path):
    """The runs of a table. Those of which README.md and docs/results.md speak must all be there."""
    runs = Runs(path, variants_of(part), part)
    if part in ("comparison", "unseen", "first_seconds", "later"):
        runs.require_all()
        runs.require(["paper", "paper_network", "handcast"])
    if part == "unseen":
        runs.require_meshes()
    return runs


def lines_of(part, path, command, people):
    """The lines of a table with all that stands below it, or of its short form."""
    if part in SUMMARIES:
        short_form, table_part = SUMMARIES[part]
        return list(short_form(runs_of(table_part, path), people))
    if part in hardware.TABLES:
        return list(hardware.TABLES[part](path, command))
    if part not in PARTS:
        die(f"there is no table '{part}'; there are: {', '.join([*PARTS, *SUMMARIES, *hardware.TABLES])}")
    runs = runs_of(part, path)
    lines, below = list(table(part, runs)), verdict(part, runs)
    return [*lines, *([""] if below else []), *below, "", *footer(runs, command, people)]


def main():
    if len(sys.argv) not in (4, 5, 6) or "-h" in sys.argv or "--help" in sys.argv:
        sys.exit(__doc__)
    part, results, document = sys.argv[1:4]
    command = sys.argv[4] if len(sys.argv) > 4 else ""
    people = sys.argv[5] if len(sys.argv) > 5 else "0"
    if not is_count(people):
        die(f"PEOPLE must be a number, and not '{people}'")
    write_whole(document, replaced(document, part, wrapped(lines_of(part, results, command, int(people)))))


main()
