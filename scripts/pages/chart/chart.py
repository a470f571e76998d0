# SPDX-License-Identifier: Apache-2.0
"""A chart: its picture, its words and the numbers behind it."""
from dataclasses import dataclass, field
from typing import Callable


@dataclass
class Chart:
    """A chart, or what the results lack for it."""
    name: str              # of its files, without extension
    title: str             # heading on the page
    reading: str           # explanation on the page
    draw: Callable = None  # makes the Picture in the colours that it is given; None if the results lack what the chart needs
    lacking: str = ""      # "needs runs ...", without a picture
    tables: list = field(default_factory=list)  # NumberTable
