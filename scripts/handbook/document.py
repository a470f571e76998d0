# SPDX-License-Identifier: Apache-2.0
"""A document in Markdown as HTML, with what other pages need of it: its headings, the files it shows, its words."""
import html
import posixpath
import re
from dataclasses import dataclass, field

from markdown_it import MarkdownIt

from handbook.anchors import anchor_of
from handbook.chapters import name_of

ELSEWHERE = re.compile(r"[a-z]+:")
# A picture that is shown only if it has been made: <!-- picture: docs/report.png What it shows -->
PICTURE = re.compile(r"<!-- picture: (\S+) (.*?) -->", re.S)
# A comment in a listing of commands or settings, to the end of its line.
COMMENT = re.compile(r"(^|\s\s)(#\s.*)$", re.M)

# A cell of a table that is not broken into lines: 0.62 ± 0.03, **5.6 / 13.3**
FIGURE = re.compile(r"[\d\s.,/±×%()*−-]+")


@dataclass
class Section:
    """A heading and what stands below it, as far as the next one. The first section has the anchor ""."""
    level: int
    anchor: str
    heading: str
    text: list[str] = field(default_factory=list)


@dataclass
class Document:
    """`files`: what is shown or linked and is no document, as paths from the root."""
    path: str
    title: str = ""
    body: str = ""
    sections: list[Section] = field(default_factory=list)
    files: set[str] = field(default_factory=set)

    def contents(self):
        """The sections of the table of contents."""
        return [section for section in self.sections if section.level in (2, 3)]


def address_of(path):
    """The page of a document: docs/tour.md is docs/tour.html."""
    return path.removesuffix(".md") + ".html"


def target_of(document, link):
    """The path from the root of what a document links."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(document.path), link.partition("#")[0]))


def picture(source, text):
    """A picture that leads to itself in its own size."""
    return f'<a href="{html.escape(source)}"><img src="{html.escape(source)}" alt="{html.escape(text)}" loading="lazy"></a>'


def listing(text):
    coloured = COMMENT.sub(r"\1<i>\2</i>", html.escape(text, quote=False))
    return f"<pre><code>{coloured}</code></pre>\n"


def title_of(text):
    return re.search(r"^# (.*)", text, re.M)[1]


RULES = {
    "table_open": lambda *_: '<div class="wide"><table>\n',
    "table_close": lambda *_: "</table></div>\n",
    "code_block": lambda tokens, i, *_: listing(tokens[i].content),
    "fence": lambda tokens, i, *_: listing(tokens[i].content),
    "image": lambda tokens, i, *_: picture(tokens[i].attrGet("src"), tokens[i].content),
    "html_block": lambda tokens, i, *_: tokens[i].meta["shown"],
    "html_inline": lambda tokens, i, *_: html.escape(tokens[i].content),
}


class Reader:
    """Reads documents. `texts`: those of all, by their paths; `made`: the paths of pictures that were made for them."""

    def __init__(self, texts, made):
        self.names, self.made = {path: name_of(path, title_of(text)) for path, text in texts.items()}, made
        self.markdown = MarkdownIt("commonmark").enable("table")
        self.markdown.renderer.rules.update(RULES)

    def read(self, path, text):
        document = Document(path, sections=[Section(1, "", "")])
        tokens = self.markdown.parse(text)
        for token, after in zip(tokens, [*tokens[1:], None]):
            if token.type == "heading_open":
                self.begin_section(document, token, after)
            elif token.type == "td_open" and FIGURE.fullmatch(after.content):
                token.attrSet("class", "figure")
            elif token.type == "html_block":
                token.meta["shown"] = self.picture_in(document, token.content)
            elif token.type == "inline":
                self.follow_links(document, token.children)
                document.sections[-1].text.append(plain(token))
            elif token.type in ("code_block", "fence"):
                document.sections[-1].text.append(token.content)
        document.body = self.markdown.renderer.render(tokens, self.markdown.options, {})
        return document

    @staticmethod
    def begin_section(document, token, inline):
        level, heading = int(token.tag[1]), plain(inline)
        if level == 1 and not document.title:
            document.title = document.sections[0].heading = heading
            return
        anchor = anchor_of(inline.content)
        token.attrSet("id", anchor)
        document.sections.append(Section(level, anchor, heading))

    def follow_links(self, document, tokens):
        for token, inner in zip(tokens, [*tokens[1:], None]):
            if token.type == "image":
                token.attrSet("src", self.link(document, token.attrGet("src")))
            elif token.type == "link_open":
                link = token.attrGet("href")
                token.attrSet("href", self.link(document, link))
                if inner.content.endswith(".md"):  # a file's name means nothing to who reads pages
                    inner.content = self.names[target_of(document, link)]

    def link(self, document, link):
        """A link of the document as one of its page."""
        if link.startswith("#") or ELSEWHERE.match(link):
            return link
        path = target_of(document, link)
        if path in self.names:
            target, mark, anchor = link.partition("#")
            return address_of(target) + mark + anchor
        document.files.add(path)
        return link

    def picture_in(self, document, comment):
        """A picture that a comment names, if it was made."""
        match = PICTURE.match(comment)
        if not match or match[1] not in self.made:
            return ""
        document.files.add(match[1])
        place = posixpath.relpath(match[1], posixpath.dirname(document.path) or ".")
        return f"<p>{picture(place, match[2])}</p>\n"


def plain(inline):
    """The text of a paragraph or heading, without its marks."""
    return "".join(token.content if token.type in ("text", "code_inline", "image") else " " if token.type == "softbreak" else ""
                   for token in inline.children)
