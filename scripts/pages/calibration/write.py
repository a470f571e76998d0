# SPDX-License-Identifier: Apache-2.0
"""report.html of a calibration, in the folder of its session."""
import pathlib

from pages.calibration.pictures import drawn
from pages.calibration.session import read_session
from pages.document import now, page_of
from pages.files import write_whole

DONE = 0


def plus_minus(text):
    """A text with ± for +-."""
    return text.replace("+-", "±")


def begins_with_setting(text):
    """True if a sentence begins with the name of a setting, such as projector.gamma."""
    word = text.replace(":", " ").replace(",", " ").partition(" ")[0]
    before, dot, after = word.partition(".")
    return bool(dot and before and after)


def sentence(text):
    """A part of a sentence as a whole one."""
    if not text:
        return text
    if not begins_with_setting(text):
        text = text[0].upper() + text[1:]
    return plus_minus(text if text[-1] in ".?!" else text + ".")


def page(session):
    """The bytes of the page. Raises Problem if a picture lacks its numbers."""
    steps = [(step, [drawn(*picture) for picture in step.findings.pictures]) for step in session.steps if step.findings]
    return page_of("calibration.html", f"Calibration of {session.rig}", [], session=session, steps=steps, sentence=sentence,
                   plus_minus=plus_minus, now=now())


def run(values, _complain):
    """The program."""
    folder = pathlib.Path(values.folder)
    file = folder / "report.html"
    write_whole(file, page(read_session(folder)))
    print(file)
    return DONE
