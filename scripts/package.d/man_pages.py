#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the man pages of programs from what they print with --help.

usage: man_pages.py BIN OUT PROGRAM...

For `handcast`, also writes those of its verbs that are no programs of their own. The pages have no date: the same programs
give the same pages.
"""
import gzip
import pathlib
import re
import shutil
import sys
import textwrap

sys.dont_write_bytecode = True
from help_text import Table, help_of, output_of

SEE_ALSO = "The handbook, /usr/share/doc/handcast/index.html, and its documents beside it."


def escape(text):
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("`", "\\(ga")
    return "\n".join("\\&" + line if line.startswith((".", "'")) else line for line in text.split("\n"))


def prose(text):
    """A paragraph. Lines that are indented stay lines of their own."""
    lines, was_indented = [], False
    for line in text.split("\n"):
        is_indented = line.startswith(" ")
        if lines and (is_indented or was_indented):
            lines.append(".br")
        lines.append(escape(line.strip()))
        was_indented = is_indented
    return ".PP\n" + "\n".join(lines)


def table(part):
    heading = f".SS {escape(part.heading)}\n" if part.heading else ""
    return heading + "\n".join(f".TP\n.B {escape(name)}\n{escape(text)}" for name, text in part.rows)


def name_line(sentence):
    """whatis(1) wants no sentence, but a phrase."""
    sentence = re.sub(r"\s+", " ", sentence).split(". ")[0].removesuffix(".")
    return sentence if sentence[1:2].isupper() else sentence[:1].lower() + sentence[1:]


def page(name, sentence, help_text, version):
    texts = [table(part) if isinstance(part, Table) else prose(part) for part in help_text.parts]
    return "\n".join([
        f'.TH {escape(name.upper())} 1 "" "handcast {version}" "User Commands"',
        ".SH NAME", f"{escape(name)} \\- {escape(name_line(sentence))}",
        ".SH SYNOPSIS", escape(" ".join(help_text.usage.split())),
        ".SH DESCRIPTION", *texts,
        ".SH SEE ALSO", ".PP", *([] if name == "handcast" else [".BR handcast (1)", ".PP"]), escape(SEE_ALSO), ""])


class Programs:
    def __init__(self, folder):
        self.folder = folder
        self.handcast = folder / "handcast"
        self.version = output_of(self.handcast, "--version").split()[1]
        self.overview = help_of(self.handcast)
        self.sentences = dict(self.overview.rows())

    def built_in_verbs(self):
        return [verb for verb in self.sentences
                if re.fullmatch(r"[a-z-]+", verb) and not (self.folder / f"handcast-{verb}").exists()]

    def page_of(self, program):
        if program == "handcast":
            first, *parts = self.overview.parts
            return page(program, first.partition("— ")[2], self.overview._replace(parts=parts), self.version)
        verb = program.removeprefix("handcast-")
        # Of a service that has the name of a verb (desk, watch), people read what the verb does.
        help_text = help_of(self.handcast, verb) if verb in self.sentences else help_of(self.folder / program)
        first = next((part for part in help_text.parts if isinstance(part, str)), "")
        return page(program, self.sentences.get(verb, first), help_text, self.version)

    def page_of_verb(self, verb):
        return page(f"handcast-{verb}", self.sentences[verb], help_of(self.handcast, verb), self.version)


def main(folder, out, *names):
    programs = Programs(pathlib.Path(folder).resolve())
    pages = {name: programs.page_of(name) for name in names}
    if "handcast" in names:
        pages |= {f"handcast-{verb}": programs.page_of_verb(verb) for verb in programs.built_in_verbs()}
    out = pathlib.Path(out)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    for name, text in pages.items():
        (out / f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(textwrap.dedent(__doc__))
    main(*sys.argv[1:])
