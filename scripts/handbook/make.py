#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the handbook: all documents, the verbs and a search, as pages that need no network.

usage: make.py OUT [--pictures DIR] [--bin DIR]

  --pictures DIR  Pictures that tour.py has made, by their paths in the repository: they go before those of the repository
  --bin DIR       The programs, for the page of the verbs (default: build/bin); without them, there is none

OUT gets the paths of the repository: docs/tour.md is OUT/docs/tour.html. A link that leads nowhere is an error.
"""
import argparse
import pathlib
import shutil
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import jinja2

from handbook import ROOT, search, verbs
from handbook.chapters import CHAPTERS, VERBS, name_of
from handbook.document import Reader, address_of
from handbook.links import faults_of

TEMPLATES = [pathlib.Path(__file__).parent / "templates", ROOT / "scripts/pages/templates"]
CODE = "code/index.html"  # Doxygen's pages
START_PICTURE = "config/assets/readme_looks.png"


def texts_of(handcast):
    """The texts of all documents by their paths, in the order of the handbook. Without the program, that of the verbs is missing."""
    paths = [path for chapter in CHAPTERS for path in chapter.documents]
    texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in paths if path != VERBS}
    if handcast:
        texts[VERBS] = verbs.document_of(handcast)
    return {path: texts[path] for path in paths if path in texts}


def navigation(documents, has_code):
    """Chapters with the addresses and names of their pages."""
    for title, paths in CHAPTERS:
        pages = [(address_of(path), name_of(path, documents[path].title)) for path in paths if path in documents]
        yield title, [*pages, *([(CODE, "Code")] if has_code and title == "Reference" else [])]


def write(out, address, template, **values):
    file = out / address
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(template.render(address=address, root="../" * address.count("/"), **values), encoding="utf-8")


def write_pages(out, documents, version):
    templates = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
                                   trim_blocks=True, lstrip_blocks=True)
    shared = {"chapters": list(navigation(documents, (out / CODE).exists())), "version": version}
    pages = list(documents.values())
    for before, page, after in zip([None, *pages], pages, [*pages[1:], None]):
        neighbours = [(way, address_of(each.path), name_of(each.path, each.title))
                      for way, each in (("before", before), ("after", after)) if each]
        write(out, address_of(page.path), templates.get_template("document.html"), page=page, neighbours=neighbours, **shared)
    write(out, "index.html", templates.get_template("start.html"), picture=START_PICTURE, **shared)
    for name in ("handbook.css", "handbook.js"):
        write(out, name, templates.get_template(name))
    (out / "handbook-index.js").write_text(search.index_of(pages), encoding="utf-8")


def copy_files(out, paths, pictures):
    for path in paths:
        made = pictures / path
        target = out / path
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(made if made.exists() else ROOT / path, target)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.partition("usage: ")[2].rstrip())
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, default=pathlib.Path("/nonexistent"))
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build/bin")
    given = parser.parse_args()
    program = given.bin / "handcast"
    handcast = program if program.exists() else None
    texts = texts_of(handcast)
    made = {file.relative_to(given.pictures).as_posix() for file in given.pictures.rglob("*.png")}
    reader = Reader(texts, made)
    documents = {path: reader.read(path, text) for path, text in texts.items()}
    write_pages(given.out, documents, verbs.version_of(handcast) if handcast else "")
    copy_files(given.out, {START_PICTURE}.union(*(page.files for page in documents.values())), given.pictures)
    if faults := faults_of(given.out):
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
