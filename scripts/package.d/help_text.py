# SPDX-License-Identifier: Apache-2.0
"""What the programs print with --help, in parts."""
import re
import subprocess
from typing import NamedTuple

# "  --seconds N           Stops after N seconds", or the name alone with the text on the next lines.
ENTRY = re.compile(r"  (\S.*?)(?:  +(\S.*))?$")
CONTINUATION = re.compile(r" {10,}(\S.*)$")


class Table(NamedTuple):
    """Options, arguments or verbs with their sentences, and what stands above them ("" if nothing does)."""
    heading: str
    rows: list[tuple[str, str]]


class Help(NamedTuple):
    """`parts`: the paragraphs, texts and tables, in their order."""
    usage: str
    parts: list[str | Table]

    def rows(self):
        return [row for part in self.parts if isinstance(part, Table) for row in part.rows]


def rows_of(lines):
    """The rows of a table; none if one of the lines does not belong to one."""
    rows = []
    for number, line in enumerate(lines):
        follows = number + 1 < len(lines) and CONTINUATION.match(lines[number + 1])
        if more := CONTINUATION.match(line):
            if not rows:
                return []
            rows[-1][1].append(more[1])
        elif (entry := ENTRY.match(line)) and (entry[2] or follows):
            rows.append((entry[1], [entry[2]] if entry[2] else []))
        else:
            return []
    return [(name, " ".join(text)) for name, text in rows]


def part_of(paragraph):
    lines = paragraph.split("\n")
    if rows := rows_of(lines):
        return Table("", rows)
    if rows := rows_of(lines[1:]):
        return Table(lines[0].rstrip(":"), rows)
    return paragraph


def parse(text):
    paragraphs = [each.strip("\n") for each in text.split("\n\n") if each.strip()]
    usage = next(each for each in paragraphs if each.startswith("usage: "))
    return Help(usage.removeprefix("usage: "), [part_of(each) for each in paragraphs if each != usage])


def output_of(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, encoding="utf-8").stdout


def help_of(*command):
    return parse(output_of(*command, "--help"))
