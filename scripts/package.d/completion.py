#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the completion of `handcast` for bash, from what the programs say about themselves.

usage: completion.py BIN TEMPLATE FILE

Verbs and options come from --help, settings and their words from `handcast config --reference`, services and back ends from
`handcast-X --describe`, looks from the folder of looks.
"""
import json
import pathlib
import re
import sys
import textwrap

sys.dont_write_bytecode = True
from help_text import help_of, output_of

SECTION = re.compile(r"## \[(.+)\]$")
SETTING = re.compile(r"\| `([\w.]+)`( \(live\))? \| .*? \| (.*?) \|")  # name, default, what is allowed


def options_of(rows):
    """Option -> the words that it accepts ("on off"), or what its value is called ("DIR"); "" without a value."""
    options = {}
    for name, _ in rows:
        if name.startswith("-"):
            last, _, value = name.split(", ")[-1].partition(" ")
            options[last] = value.replace("|", " ") if "|" in value else value
    return options


def words_of(rows):
    """The words that a verb accepts as its first argument, "[on|off]" or a table of them, or what that is called ("DIR")."""
    names = [name.strip("[]").removesuffix("...").replace("|", " ") for name, _ in rows if not name.startswith("-")]
    return " ".join(names) if all(name.islower() for name in names) else names[0]


def settings_of(reference):
    """Path -> the words that it accepts, of the page config/REFERENCE.md; and the paths that change live."""
    words, live, section = {}, [], ""
    for line in reference.split("\n# Back ends")[0].splitlines():
        if heading := SECTION.match(line):
            section = heading[1] + "."
        elif setting := SETTING.match(line):
            path = section + setting[1]
            words[path] = " ".join(re.findall(r"`([\w.-]+)`", setting[3]))
            if setting[2]:
                live.append(path)
    return words, live


def backends_of(folder):
    """Service -> its back ends."""
    described = [json.loads(file.read_text(encoding="utf-8")) for file in sorted(folder.glob("*.json"))]
    return {each["name"]: " ".join(backend["name"] for backend in each["backends"]) for each in described}


def table(name, pairs):
    rows = "".join(f"  [{key}]='{words}'\n" for key, words in pairs.items() if words)
    return f"declare -gA {name}=(\n{rows})"


def main(folder, template, file):
    folder = pathlib.Path(folder)
    handcast = folder / "handcast"
    verbs = [name for name, _ in help_of(handcast).rows() if re.fullmatch(r"[a-z-]+", name)]
    rows = {verb: help_of(handcast, verb).rows() for verb in verbs}
    settings, live = settings_of(output_of(handcast, "config", "--reference"))
    share = folder.parent / "share/handcast"
    looks = sorted(each.stem for each in (share / "looks").glob("*.fs"))
    values = {f"{verb}{option}": value for verb in verbs for option, value in options_of(rows[verb]).items()}
    tables = {
        "VERBS": "_handcast_verbs='" + " ".join([*verbs, "help", "version"]) + "'",
        "OPTIONS": table("_handcast_options", {verb: " ".join(options_of(rows[verb])) for verb in verbs}),
        "VALUES": table("_handcast_values", values),
        "WORDS": table("_handcast_words", {verb: words_of(rows[verb]) for verb in verbs}),
        "SETTINGS": "_handcast_settings='" + " ".join(settings) + "'",
        "LIVE": "_handcast_live='" + " ".join(live) + "'",
        "CHOICES": table("_handcast_choices", settings),
        "BACKENDS": table("_handcast_backends", backends_of(share / "services")),
        "LOOKS": "_handcast_looks='" + " ".join(looks) + "'"}
    text = pathlib.Path(template).read_text(encoding="utf-8")
    for name, value in tables.items():
        text = text.replace(f"@{name}@", value)
    pathlib.Path(file).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(textwrap.dedent(__doc__))
    main(*sys.argv[1:])
