#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the listing of a Markdown page that begins with ```LANGUAGE NAME to a file.

usage: listing.py PAGE.md NAME FILE
"""
import pathlib
import re
import sys

page, name, file = sys.argv[1:]
text = pathlib.Path(page).read_text(encoding="utf-8")
found = re.search(r"^```\w+ " + re.escape(name) + r"\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
if not found:
    sys.exit(f"{page}: there is no listing '{name}'")
pathlib.Path(file).write_text(found[1], encoding="utf-8")
