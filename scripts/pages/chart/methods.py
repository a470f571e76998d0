# SPDX-License-Identifier: Apache-2.0
"""How the variants of plans are presented in charts."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    """A variant in charts."""
    variant: str           # its name in the plan
    label: str             # its name in charts
    colour: str = "ink"    # of points and lines, in palette.py
    freedoms: int = None   # degrees of freedom of the correction, for each hand; rungs only
    detects: bool = False  # handcast with a real detector of measured age

    @property
    def is_ours(self):
        """True for the method that all others are compared with."""
        return self.variant == "handcast"

    @property
    def is_rung(self):
        """True for a rung below handcast."""
        return self.freedoms is not None and not self.is_ours


# The rungs of the ladder (`docs/method.md#ladder`), the least first. 21 landmarks have 42 degrees of freedom; registration adds 3 + 2 x 5.
# The last one is handcast itself.
RUNGS = (
    Method("hold", "hold", "ours", 0),
    Method("predict", "predict", "ours", 0),
    Method("shift", "shift", "ours", 2),
    Method("similarity", "similarity", "ours", 4),
    Method("fingers", "per finger", "ours", 14),
    Method("landmarks", "landmarks", "ours", 42),
    Method("handcast", "handcast", "ours", 55),
)

OTHERS = (
    Method("baseline", "baseline", "baseline"),
    Method("paper", "paper as published", "cascade"),
    Method("paper_at_our_speed", "paper at our speed", "cascade"),
    Method("ideal", "ideal landmarks", "quiet"),
    Method("handcast_network", "with our network", "fast", detects=True),
    Method("mediapipe", "with MediaPipe", "fast", detects=True),
)

# The variants that the failure atlas compares.
COMPARED = ("baseline", "paper", "handcast")


def method_of(variant):
    """The method of a variant. An unknown one has its name as label and the colour of text."""
    return next((method for method in RUNGS + OTHERS if method.variant == variant), Method(variant, variant))
