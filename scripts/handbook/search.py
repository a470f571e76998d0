# SPDX-License-Identifier: Apache-2.0
"""The index of the search: which words stand in which section, as a script that a page loads when somebody searches."""
import json
import re

from handbook.chapters import HISTORY
from handbook.document import address_of

WORD = re.compile(r"[^\W_][\w.+-]*\w")
COMMON = frozenset("""a an and are as at be but by can for from has have if in into is it its of on one or so than that the their them then
    there they this to was what when which who with without not no all also do does each other only you your""".split())


def words_of(text):
    """The distinct words of a text that somebody may search, in the order of the alphabet. Numbers are none."""
    return sorted({word for word in WORD.findall(text.lower()) if word not in COMMON and re.search(r"[^\W\d]{2}", word)})


def index_of(documents):
    """`pages`: address, title and worth of each. `sections`: number of the page, anchor, heading and words of each."""
    pages = [(address_of(document.path), document.title, 0.5 if document.path in HISTORY else 1) for document in documents]
    sections = [(number, section.anchor, section.heading, " ".join(words_of(" ".join(section.text))))
                for number, document in enumerate(documents) for section in document.sections]
    index = json.dumps({"pages": pages, "sections": sections}, ensure_ascii=False, separators=(",", ":"))
    return f"handbookIndex={index}\n"
