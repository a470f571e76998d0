# SPDX-License-Identifier: Apache-2.0
"""The order of the handbook: its chapters, and the documents of each. A test finds documents that are in none."""
from typing import NamedTuple


class Chapter(NamedTuple):
    title: str
    documents: tuple[str, ...]


# Documents that are made, not written: what the verbs print with --help.
VERBS = "verbs.md"

CHAPTERS = (
    Chapter("Begin", ("docs/tour.md", "docs/recipes.md", "docs/operating/trouble.md", "README.md")),
    Chapter("Artists", ("docs/operating/artist.md", "docs/operating/content.md", "docs/operating/desk.md")),
    Chapter("Technicians", ("docs/operating.md", "docs/operating/technician.md", "docs/operating/night-watch.md", "docs/operating/two-computers.md",
                            "docs/operating/two-projectors.md",
                            "docs/operating/cameras.md", "docs/operating/trackers.md", "docs/operating/light.md",
                            "docs/operating/questions.md", "docs/operating/figures.md")),
    Chapter("Researchers", ("docs/results.md", "docs/method.md", "docs/studies.md", "docs/benchmark.md",
                            "docs/operating/your-own-tracker.md", "docs/recordings.md")),
    Chapter("Programmers", ("docs/architecture.md", "docs/operating/integrator.md", "docs/writing-a-back-end.md", "renderer/README.md",
                            "ipc/ring/README.md", "CONTRIBUTING.md", "DECISIONS.md", "CHANGELOG.md")),
    Chapter("Laboratory", ("docs/lab/README.md", "docs/lab/twin.md", "docs/lab/charts.md", "docs/lab/results_tables.md",
                           "docs/lab/measurements.md", "docs/lab/experiments.md", "services/lab/training/MODEL_CARD.md")),
    Chapter("Reference", (VERBS, "config/REFERENCE.md")),
)

# Documents of how handcast came to be, which the search lists last.
HISTORY = frozenset(("DECISIONS.md", "CHANGELOG.md", "docs/lab/experiments.md", "docs/lab/measurements.md"))

# Names in the navigation that are shorter than the headings.
SHORT_NAMES = {
    "README.md": "Overview",
    "CONTRIBUTING.md": "Contributing",
    "docs/operating/figures.md": "Figures",
    "docs/operating/artist.md": "Pictures",
    "docs/operating/technician.md": "Install, calibrate, run",
    "docs/operating/integrator.md": "Integrate",
    "docs/operating/your-own-tracker.md": "Your own tracker",
    "docs/lab/README.md": "Notes",
    "docs/lab/experiments.md": "Experiments",
    "renderer/README.md": "The renderer",
    "services/lab/training/MODEL_CARD.md": "Landmark network",
}


def name_of(path, title):
    """The name of a document in the navigation: its heading up to a colon, if there is no shorter name."""
    return SHORT_NAMES.get(path, title.partition(":")[0])
