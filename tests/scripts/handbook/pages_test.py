# SPDX-License-Identifier: Apache-2.0
"""The handbook holds all documents and verbs, and each of its links leads somewhere."""
import json
import re
import subprocess
import unittest

from made_handbook import BIN, REPOSITORY, Made

import budgets
from handbook import verbs
from handbook.chapters import CHAPTERS, VERBS
from handbook.document import Reader
from handbook.links import faults_of


def documents():
    """The paths of all documents of the repository, the generated ones, too."""
    paths = (path.relative_to(REPOSITORY).as_posix() for path in REPOSITORY.rglob("*.md"))
    return {path for path in paths if not budgets.NO_DOCUMENTS.match(path)}


def overview():
    """What `handcast help` prints."""
    return subprocess.run([BIN / "handcast", "help"], capture_output=True, text=True, check=True).stdout


def page_of(text, made=()):
    """A document at book/page.md as HTML; there is another one, book/other.md."""
    return Reader({"book/page.md": text, "book/other.md": "# Another page\n"}, set(made)).read("book/page.md", text)


class ADocument(unittest.TestCase):
    def test_leads_to_pages_where_it_leads_to_documents(self):
        body = page_of("# Page\n\n[there](other.md#a-place), [back](#page)\n").body
        self.assertIn('<a href="other.html#a-place">there</a>', body)
        self.assertIn('<a href="#page">back</a>', body)

    def test_names_a_page_by_its_heading_and_not_by_its_file(self):
        self.assertIn('<a href="other.html">Another page</a>', page_of("# Page\n\n[book/other.md](other.md)\n").body)

    def test_has_headings_with_the_anchors_that_check_docs_knows(self):
        page = page_of("# Page\n\n## What `up` does: *all*\n")
        self.assertIn('<h2 id="what-up-does-all">', page.body)
        self.assertEqual([section.heading for section in page.contents()], ["What up does: all"])

    def test_keeps_what_is_no_document_beside_it(self):
        self.assertEqual(page_of("# Page\n\n![a](../config/a.png) [b](b.py)\n").files, {"config/a.png", "book/b.py"})

    def test_shows_a_picture_only_if_it_has_been_made(self):
        text = "# Page\n\n<!-- picture: book/a.png What it shows -->\n"
        self.assertNotIn("<img", page_of(text).body)
        self.assertIn('<img src="a.png" alt="What it shows"', page_of(text, made=["book/a.png"]).body)

    def test_keeps_figures_in_a_table_on_one_line(self):
        body = page_of("# Page\n\n| a | b |\n|---|---|\n| 0.62 ± 0.03 | two words |\n").body
        self.assertIn('<td class="figure">0.62 ± 0.03</td>', body)
        self.assertIn("<td>two words</td>", body)

    def test_of_help_has_listings_where_lines_are_indented(self):
        self.assertEqual(verbs.prose("Set `a_b` to a_b:\n  --set a_b=1\nand go on."), "Set `a_b` to a\\_b:\n\n    --set a_b=1\n\nand go on.")

    def test_shows_marks_of_html_as_they_are_written(self):
        body = page_of("# Page\n\na <b> c\n\n    if a < b  # <b>\n").body
        self.assertIn("a &lt;b&gt; c", body)
        self.assertIn("if a &lt; b  <i># &lt;b&gt;</i>", body)


class TheHandbook(Made):
    def test_holds_every_document_once(self):
        held = [path for chapter in CHAPTERS for path in chapter.documents]
        self.assertEqual(sorted(held), sorted({*documents(), VERBS}))

    def test_has_no_link_that_leads_nowhere_and_takes_nothing_from_a_network(self):
        self.assertEqual(faults_of(self.folder), [])

    def test_would_be_refused_with_a_fault(self):
        for planted in ('<a href="gone.html">', '<a href="docs/tour.html#gone">', '<img src="gone.png">', '<a href="../outside.html">',
                        '<script src="https://example.org/a.js">', '<img srcset="//example.org/a.png">'):
            copy = self.copy()
            with (copy / "index.html").open("a", encoding="utf-8") as page:
                page.write(planted)
            self.assertEqual(len(faults_of(copy)), 1, planted)

    def test_explains_each_verb_with_its_options(self):
        names = re.findall(r"^  ([a-z-]+)  ", overview(), re.M)
        page = (self.folder / "verbs.html").read_text(encoding="utf-8")
        self.assertGreater(len(names), 30)
        self.assertEqual([verb for verb in names if f'<h3 id="{verb}">' not in page], [])
        self.assertRegex(page, r"<code>--seconds N</code></td>\s*<td>Stops after N seconds")

    def test_says_in_its_index_which_words_a_section_has(self):
        script = (self.folder / "handbook-index.js").read_text(encoding="utf-8")
        index = json.loads(script.removeprefix("handbookIndex="))
        found = [(index["pages"][page][0], anchor) for page, anchor, _, words in index["sections"] if "plugdev" in words.split()]
        self.assertIn(("docs/operating/technician.html", "what-is-attached"), found)
        self.assertLess(len(script), 500_000)

    def test_is_the_same_if_it_is_made_again(self):
        again = self.copy()
        subprocess.run([REPOSITORY / "scripts/handbook/make.py", again, "--bin", BIN], check=True)
        for file in filter(lambda path: path.is_file(), self.folder.rglob("*")):
            self.assertEqual(file.read_bytes(), (again / file.relative_to(self.folder)).read_bytes(), file)


class TheTour(unittest.TestCase):
    def test_calls_verbs_that_there_are(self):
        text = (REPOSITORY / "docs/tour.md").read_text(encoding="utf-8")
        called = set(re.findall(r"^    build/bin/handcast ([a-z-]+)", text, re.M))
        self.assertGreater(len(called), 6)
        self.assertEqual([verb for verb in called if not re.search(rf"^  {verb}  ", overview(), re.M)], [])


if __name__ == "__main__":
    unittest.main()
