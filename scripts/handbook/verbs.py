# SPDX-License-Identifier: Apache-2.0
"""The document of all verbs, from what they print with --help, as the man pages are."""
import itertools
import re
import sys

from handbook import ROOT

sys.path.insert(0, str(ROOT / "scripts/package.d"))
from help_text import Table, help_of, output_of  # its folder is no package

MARKS = re.compile(r"([\\*_\[\]<>|])")


def version_of(handcast):
    return output_of(handcast, "--version").split()[1]


def prose(text):
    """A paragraph of help as Markdown. Lines that are indented are listings."""
    runs = itertools.groupby(text.split("\n"), key=lambda line: line.startswith(" "))
    return "\n\n".join("\n".join(f"    {line.strip()}" if is_listing else escaped(line) for line in lines) for is_listing, lines in runs)


def escaped(text):
    """Markdown that shows this text: the words between backticks as code, everything else as it is."""
    parts = text.split("`")
    return "`".join(part if number % 2 else MARKS.sub(r"\\\1", part) for number, part in enumerate(parts))


def in_cell(code):
    """Code in the cell of a table, which ends at a bar."""
    return "`" + code.replace("|", r"\|") + "`"


def table(part):
    rows = [f"| {in_cell(name)} | {escaped(text)} |" for name, text in part.rows]
    heading = f"{escaped(part.heading)}:\n\n" if part.heading else ""
    return heading + "\n".join(["| | |", "|---|---|", *rows])


def part_of(part):
    return table(part) if isinstance(part, Table) else prose(part)


def document_of(handcast):
    """The text of the document. `handcast`: the program."""
    overview = help_of(handcast)
    text = ["# Verbs", "What `handcast help VERB` prints."]
    for group in (part for part in overview.parts if isinstance(part, Table)):
        verbs = [verb for verb, _ in group.rows if re.fullmatch(r"[a-z-]+", verb)]
        if not verbs:
            continue
        text.append(f"## To {group.heading}")
        for verb in verbs:
            told = help_of(handcast, verb)
            usage = "\n".join("    " + line for line in told.usage.split("\n"))
            text += [f"### {verb}", usage, *map(part_of, told.parts)]
    return "\n\n".join(text) + "\n"
