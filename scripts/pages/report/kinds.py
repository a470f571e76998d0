# SPDX-License-Identifier: Apache-2.0
"""The kinds of the figures in the files of simulate, observer and supervisor that the page shows."""
import json
import math

MOST_DEPTH = 32  # of nested JSON: printing it recurses

NUMBERS = ("frames", "coverage", "spill", "iou", "seam_px", "jitter_px", "missing", "residual_px", "foldovers",
           "equivalent_latency_ms", "software_ms", "seconds", "seed")
TEXTS = ("rig", "motion")
FIGURES = ("interior_mm", "interior_px", "frame_us")           # objects of numbers
TABLES = ("stage_us", "rates", "slow_frames")                 # objects of figures
GROUPS = ("bins", "services")                                 # objects of objects, whose members are not checked


def is_number(value):
    """True for a number of JSON; True and False are none."""
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def wrong_number(value, place):
    """What is wrong with a value that should be a number; "" if nothing is. None was not measured."""
    return "" if value is None or is_number(value) else f"{place} must be a number"


def wrong_text(value, place):
    """What is wrong with a value that should be a text."""
    return "" if value is None or isinstance(value, str) else f"{place} must be a text"


def wrong_object(value, place, wrong_member=lambda value, place: ""):
    """What is wrong with a value that should be an object, or with the first of its members that is wrong."""
    if value is None:
        return ""
    if not isinstance(value, dict):
        return f"{place} must be an object"
    return next(filter(None, (wrong_member(member, f"{place}/{name}") for name, member in value.items())), "")


def wrong_figures(value, place):
    """What is wrong with a value that should be an object of numbers."""
    return wrong_object(value, place, wrong_number)


CHECKS = (
    *((key, wrong_number) for key in NUMBERS),
    *((key, wrong_text) for key in TEXTS),
    *((key, wrong_figures) for key in FIGURES),
    *((key, lambda value, place: wrong_object(value, place, wrong_figures)) for key in TABLES),
    *((key, lambda value, place: wrong_object(value, place, wrong_object)) for key in GROUPS),
)


def wrong_kind(results):
    """The first value of a file of results that is not of the kind that the page needs, as "/coverage must be a number"; "" if there
    is none."""
    return next(filter(None, (check(results.get(key), f"/{key}") for key, check in CHECKS)), "")


def finite(text):
    """A number of JSON. Raises ValueError if it is none or too large."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is not a number")
    return number


def whole(text):
    """A whole number of JSON; one of very many digits becomes a float."""
    return int(text) if len(text) < 19 else finite(text)


def depth_of(value):
    """How deep lists and objects are nested in a value."""
    members = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return 1 + max(map(depth_of, members)) if members else 0


def parse_shallow(content):
    """The value of JSON in UTF-8 that is nested at most MOST_DEPTH deep; None if the bytes are none."""
    try:
        value = json.loads(content.decode("utf-8"), parse_float=finite, parse_int=whole, parse_constant=finite)
        json.dumps(value, ensure_ascii=False).encode()  # refuses halves of characters
        return value if depth_of(value) <= MOST_DEPTH else None
    except (ValueError, RecursionError):
        return None
