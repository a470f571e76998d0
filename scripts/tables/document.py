# SPDX-License-Identifier: Apache-2.0
"""Text between marks of a document, which is replaced as a whole."""

import os
import re
import textwrap

from tables.runs import die

WIDTH = 120  # of a line that is no row of a table


def wrapped(lines):
    """The lines, those that are no rows of tables broken at WIDTH; a code span keeps its line."""
    for line in lines:
        if line.startswith("|") or len(line) <= WIDTH:
            yield line
            continue
        whole = re.sub("`[^`]*`", lambda span: span[0].replace(" ", "\0"), line)
        for part in textwrap.wrap(whole, WIDTH, break_long_words=False, break_on_hyphens=False):
            yield part.replace("\0", " ")


def replaced(document, part, lines):
    """The text of a document with these lines between the marks of `part`."""
    try:
        with open(document, newline="", encoding="utf-8") as file:
            text = file.read()
    except (OSError, UnicodeDecodeError) as error:
        die(f"{document} cannot be read: {error}")
    begin, end = f"<!-- {part}: begin -->", f"<!-- {part}: end -->"
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(end) < text.index(begin):
        die(f"{document} must have the lines {begin} and {end}, each once and in this order")
    before, rest = text.split(begin)
    old, after = rest.split(end)
    if "<!-- " in old:
        die(f"{document} has other marks between {begin} and {end}")
    newline = "\r\n" if "\r\n" in text else "\n"
    return before + begin + newline + newline.join(lines) + newline + end + after


def write_whole(document, text):
    """Replaces a file by a text as a whole: if that fails, the old one is untouched."""
    beside = f"{document}.new"
    try:
        with open(beside, "w", newline="", encoding="utf-8") as file:
            file.write(text)
        os.chmod(beside, os.stat(document).st_mode & 0o7777)
        os.replace(beside, document)
    except OSError as error:
        if os.path.exists(beside):
            os.remove(beside)
        die(f"{document} cannot be written: {error}")
