# SPDX-License-Identifier: Apache-2.0
"""The files of a demonstration that a report is made of."""
import json
import pathlib
from dataclasses import dataclass, field

from pages.files import MOST_TEXT, Problem, read_input
from pages.report.kinds import is_number, parse_shallow, wrong_kind


@dataclass
class Source:
    """A JSON file of the folder."""
    file: str              # "paper.json"
    content: dict = None   # None if there is a problem
    problem: str = ""      # "paper.json is missing"
    missing: bool = False  # the problem is that there is no such file

    def value(self, *place):
        """The value at a place of the content; None if there is none."""
        value = self.content
        for key in place:
            value = value.get(key) if isinstance(value, dict) else None
        return value

    def number(self, *place):
        """The number at a place of the content; None if there is none."""
        value = self.value(*place)
        return value if is_number(value) else None


@dataclass
class Run:
    """One simulated method. All runs of a report have the same truth."""
    name: str      # on the page: "handcast"
    sentence: str  # what it is, on the page
    metrics: Source
    pictures: list = field(default_factory=list)  # files in the order of their numbers


@dataclass
class Inputs:
    """The input of a report."""
    runs: list          # Run: baseline, paper, handcast
    equal_legs: Source  # handcast with the software time of the paper
    live: Source        # rates, restarts and stage times of a live run, from the supervisor
    observer: Source    # the observer's score of the live run

    def sources(self):
        """All JSON files."""
        return [*(run.metrics for run in self.runs), self.equal_legs, self.live, self.observer]

    def faults(self):
        """What is wrong with the files that are there, a sentence each."""
        return [source.problem for source in self.sources() if source.problem and not source.missing]


def read_source(folder, name):
    """A JSON file with figures of the right kinds, or what is wrong with it."""
    if not (folder / name).exists():
        return Source(name, problem=f"{name} is missing", missing=True)
    try:
        content = parse_shallow(read_input(folder / name, MOST_TEXT))
    except Problem as problem:
        return Source(name, problem=str(problem))
    if not isinstance(content, dict):
        return Source(name, problem=f"{name} is not a JSON object")
    wrong = wrong_kind(content)
    return Source(name, problem=f"{name}: {wrong}") if wrong else Source(name, content)


def read_run(folder, stem, name, sentence):
    """A run with its figures and pictures."""
    return Run(name, sentence, read_source(folder, f"{stem}.json"), sorted((folder / "frames" / stem).glob("*.png")))


def read_inputs(folder):
    """The files of a folder. A missing or malformed one is a problem of its source. Raises Problem if there is nothing at all."""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise Problem(f"'{folder}' is not a folder")
    runs = [read_run(folder, "baseline", "baseline", "The tracker's hand at its predicted pose, without any correction."),
            read_run(folder, "paper", "paper", "The cascade as described in the paper."),
            read_run(folder, "twin", "handcast", "The cascade of this software.")]
    inputs = Inputs(runs, *(read_source(folder, name) for name in ("equal_legs.json", "live.json", "observer.json")))
    if not any(source.content for source in inputs.sources()) and not any(run.pictures for run in runs):
        raise Problem(f"'{folder}' has nothing to report: there is none of baseline.json, paper.json, twin.json, live.json and "
                      "observer.json, and there are no pictures in frames/")
    return inputs


def gather_metrics(inputs):
    """The content of metrics.json: baseline, paper, handcast, handcast_equal_legs, and live with the observer's score. Missing ones
    are left out."""
    named = {run.name: run.metrics for run in inputs.runs} | {"handcast_equal_legs": inputs.equal_legs, "live": inputs.live}
    metrics = {name: dict(source.content) for name, source in named.items() if source.content is not None}
    if inputs.observer.content is not None:
        metrics.setdefault("live", {})["observer"] = inputs.observer.content
    return (json.dumps(metrics, indent=2, sort_keys=True, ensure_ascii=False) + "\n").encode()
