# SPDX-License-Identifier: Apache-2.0
"""The links of a made handbook: all lead to something in it, and nothing is taken from a network."""
import html.parser
import posixpath
from urllib.parse import unquote, urlsplit

# Doxygen checks its own.
NOT_CHECKED = "code/"


class Page(html.parser.HTMLParser):
    """`links`: what the page links; `parts`: what it shows or loads; `anchors`: the names of its places."""

    def __init__(self, text):
        super().__init__()
        self.links, self.parts, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id":
                self.anchors.add(value)
            if name == "href" and tag == "a":
                self.links.append(value)
            elif name in ("href", "src", "srcset"):
                self.parts.append(value)


def fault_of(folder, pages, place, link):
    """What is wrong with a link of the page at a place; None if it leads somewhere."""
    url = urlsplit(link)
    target = posixpath.normpath(posixpath.join(posixpath.dirname(place), unquote(url.path))) if url.path else place
    if target.startswith("..") or not (folder / target).is_file():
        return f"{place}: {link} leads nowhere"
    if url.fragment and target in pages and unquote(url.fragment) not in pages[target].anchors:
        return f"{place}: {target} has no place #{url.fragment}"
    return None


def faults_of(folder):
    """What is wrong with the pages of a folder, a sentence each."""
    pages = {file.relative_to(folder).as_posix(): Page(file.read_text(encoding="utf-8")) for file in sorted(folder.rglob("*.html"))
             if not file.relative_to(folder).as_posix().startswith(NOT_CHECKED)}
    faults = []
    for place, page in pages.items():
        outside = [part for part in page.parts if urlsplit(part).scheme not in ("", "data") or part.startswith("//")]
        faults += [f"{place}: {part} is taken from a network" for part in outside]
        inside = [link for link in page.links + page.parts if link not in outside and not urlsplit(link).scheme]
        faults += filter(None, (fault_of(folder, pages, place, link) for link in inside))
    return faults
