# SPDX-License-Identifier: Apache-2.0
"""The sizes that the repository keeps, so that one person can read it. scripts/check_layers enforces them.

A limit is raised only with a sentence in DECISIONS.md.
"""
import collections
import pathlib
import re
import statistics

SHOW_LINES = 68_120
SHOW_FILES = 768
MEDIAN_LINES = 64  # of a source, at least: a file is a subject, not a function. The aim is 70.
FOLDED_LINES = 300  # a header with one user is part of it, unless the file becomes longer than this
UNFOLDED_HEADERS = 3  # the most that may be left to fold. The aim is none.
DOCUMENT_WORDS = 53_000  # without the generated ones
DOCUMENT_COLUMNS = 120
README_LINES = 120
DECISION_LINES = 6

# What runs while there is light: neither its tools, laboratory and studies nor the drivers, of which a rig uses one or two;
# the service that runs a stranger's program is one of them, the night watch, which changes two settings a day, and the bridge,
# for shows on several computers.
NOT_IN_THE_SHOW = re.compile(r"services/(tools|lab|studies)/|calib/solve/|supervisor/look/|"
                             r"services/(bridge|guest|watch|camera/(aravis|leap|v4l2)|pose/(leapc|lift|openxr|stereo)|projector/dlp|content/\w+|desk/\w+)/")
GENERATED = ("config/REFERENCE.md", "docs/lab/", "services/lab/training/MODEL_CARD.md")
NO_DOCUMENTS = re.compile(r"(build[^/]*|out|\.git|tests)/")
# The header of a handcast_embed(): the build writes its source.
EMBEDDED = re.compile(r"^extern const std::string_view k", re.M)
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)


class Sources:
    """The texts of a checkout by path from its root: production code, and the code of tests."""

    def __init__(self, root, tops):
        self.code = self._read(root, tops)
        self.tests = self._read(root, ["tests"])

    @staticmethod
    def _read(root, tops):
        return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
                for top in tops for path in sorted((root / top).rglob("*.[ch]pp"))}

    def lines(self, *files):
        return sum(self.code[file].count("\n") for file in files if file in self.code)


def size_breaches(sources):
    show = [file for file in sources.code if not NOT_IN_THE_SHOW.match(file)]
    if len(show) > SHOW_FILES:
        yield f"the show has {len(show)} files; its budget is {SHOW_FILES}"
    if (lines := sources.lines(*show)) > SHOW_LINES:
        yield f"the show has {lines} lines; its budget is {SHOW_LINES}"
    if (median := statistics.median(map(sources.lines, sources.code))) < MEDIAN_LINES:
        yield f"the median source has {median:.0f} lines; it should have {MEDIAN_LINES} or more"


def twin_of(header):
    return header.removesuffix(".hpp") + ".cpp"


def header_of(file):
    return file.removesuffix(".cpp") + ".hpp" if file.endswith(".cpp") else file


def source_of(file):
    return twin_of(file) if file.endswith(".hpp") else file


def header_breaches(sources):
    """Headers that only one file of their folder includes, and that would leave it short enough."""
    users = collections.defaultdict(set)
    for file, text in sources.code.items():
        for included in INCLUDE.findall(text):
            if file != twin_of(included):
                users[included].add(file)
    tested = {included for text in sources.tests.values() for included in INCLUDE.findall(text)}
    for header in sources.code:
        if not header.endswith(".hpp") or len(users[header]) != 1 or header in tested or \
                EMBEDDED.search(sources.code[header]):
            continue
        user, = users[header]
        here = pathlib.PurePosixPath(header).parent
        declared = sources.lines(header, header_of(user))
        defined = sources.lines(twin_of(header), source_of(user))
        if user.endswith(".cpp"):  # which then declares it, too
            defined += sources.lines(header)
        if pathlib.PurePosixPath(user).parent == here and max(declared, defined) <= FOLDED_LINES:
            yield f"{header}: only {user} includes it; fold it into that file"


def documents(root):
    for path in sorted(root.rglob("*.md")):
        name = path.relative_to(root).as_posix()
        if not NO_DOCUMENTS.match(name) and not name.startswith(GENERATED):
            yield name, path.read_text(encoding="utf-8")


def decision_breaches(text):
    heading, count = None, 0
    for line in [*text.split("\n"), "## "]:
        if line.startswith("## "):
            if heading and count > DECISION_LINES:
                yield f"DECISIONS.md: '{heading}' has {count} lines; an entry has {DECISION_LINES} at most"
            heading, count = line[3:], 0
        elif line.strip():
            count += 1


def document_breaches(root):
    words = 0
    for name, text in documents(root):
        words += len(text.split())
        for number, line in enumerate(text.split("\n"), 1):
            if len(line) > DOCUMENT_COLUMNS and not line.startswith(("|", "![", "<")):
                yield f"{name}:{number}: {len(line)} columns; a line of a document has {DOCUMENT_COLUMNS} at most"
        if name == "README.md" and text.count("\n") > README_LINES:
            yield f"README.md has {text.count(chr(10))} lines; its budget is {README_LINES}"
        if name == "DECISIONS.md":
            yield from decision_breaches(text)
    if words > DOCUMENT_WORDS:
        yield f"the documents have {words} words; their budget is {DOCUMENT_WORDS}"


def breaches(root, tops):
    sources = Sources(root, tops)
    unfolded = list(header_breaches(sources))
    return [*size_breaches(sources), *(unfolded if len(unfolded) > UNFOLDED_HEADERS else ()), *document_breaches(root)]
