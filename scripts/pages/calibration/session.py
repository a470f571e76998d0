# SPDX-License-Identifier: Apache-2.0
"""What a calibration has left in its folder: report.json, and STEP.json for each step that was measured (services/tools/calibrate)."""
import json
import math
from dataclasses import dataclass, field

from pages.files import MOST_TEXT, Problem, read_input

TITLES = {
    "lens": "Lens of the camera",
    "lens2": "Lens of the second camera",
    "pair": "Place of the second camera",
    "screen": "Projector",
    "tracker": "Place of the tracker",
    "light": "Light on the hand",
}


@dataclass
class Findings:
    """What a step has found out. `pictures`: data for pages.calibration.pictures."""
    made: str
    findings: list
    meaning: str
    pictures: list


@dataclass
class Step:
    """A step, and what the report says of it."""
    name: str  # "lens"
    made: str = ""             # how good it is, and when it was measured; may be empty
    is_done: bool = False
    findings: Findings = None  # None: not measured, or they could not be written

    @property
    def title(self):
        """Its heading."""
        return TITLES[self.name]

    @property
    def state(self):
        """A line for the header."""
        return self.made or ("measured, see below" if self.is_done else "not measured yet")


@dataclass
class Session:
    """A calibration, as far as it was measured."""
    rig: str
    rig_file: str
    board: str   # for commands; empty: the usual one
    folder: str  # for commands; empty: the one beside the rig file
    option: str = ""  # for commands; empty: none
    steps: list = field(default_factory=list)

    def missing(self):
        """The names of the steps that are left."""
        return [step.name for step in self.steps if not step.is_done]

    def command(self, *more):
        """`handcast calibrate` for this rig and this board."""
        return " ".join(filter(None, ["handcast calibrate", self.rig_file, *more, self.option, self.board and f"--board {self.board}"]))

    def command_to_go_on(self):
        """The command that goes on with this session."""
        return self.command() + (f" --folder {self.folder}" if self.folder else "")


def read_json(file):
    """The object of a JSON file. Raises Problem."""
    try:
        value = json.loads(read_input(file, MOST_TEXT).decode("utf-8"))
    except ValueError as error:
        raise Problem(f"{file}: is not JSON ({error}); measure this step again") from None
    if not isinstance(value, dict):
        raise Problem(f"{file}: is not a JSON object; measure this step again")
    return value


def numbers_of(values):
    """Numbers as floats; those that are none are NaN."""
    return [math.nan if value is None else float(value) for value in values]


def read_findings(file):
    """What a step has found out; None if there is no such file. Raises Problem."""
    if not file.exists():
        return None
    values = read_json(file)
    try:
        pictures = [(picture["kind"], picture["caption"], {name: numbers_of(values) for name, values in picture["numbers"].items()})
                    for picture in values["pictures"]]
        return Findings(str(values["made"]), list(map(str, values["findings"])), str(values["meaning"]), pictures)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise Problem(f"{file}: lacks something ({error}); measure this step again") from None


def read_session(folder):
    """The session of a folder. Raises Problem."""
    file = folder / "report.json"
    values = read_json(file)
    try:
        session = Session(*(str(values[key]) for key in ("rig", "rig_file", "board", "folder")), option=str(values.get("option", "")))
        for step in values["steps"]:
            session.steps.append(Step(step["step"], str(step["made"]), bool(step["is_done"]), read_findings(folder / f"{step['step']}.json")))
    except (KeyError, TypeError) as error:
        raise Problem(f"{file}: lacks something ({error}); measure a step again") from None
    return session
