# SPDX-License-Identifier: Apache-2.0
"""The numbers behind a chart."""
import csv
import io
from dataclasses import dataclass, field

from pages.document import figure

LONG_ROWS = 30  # a table with more rows is collapsed on the page


@dataclass(frozen=True)
class Column:
    """A column of a table. A column of times of the machine is printed in italics."""
    key: str      # heading in CSV
    heading: str  # heading on the page, with the unit
    digits: int = 2
    of_machine: bool = False

    def shown(self, cell):
        """A text, a number or None as the page shows it."""
        return cell if cell and isinstance(cell, str) else figure(cell or None if isinstance(cell, str) else cell, self.digits)


@dataclass
class NumberTable:
    """A table of texts, numbers and None, of which the file has an empty cell and the page a dash."""
    name: str     # of its file, without extension
    caption: str  # on the page
    columns: list
    rows: list = field(default_factory=list)

    @property
    def is_long(self):
        """True if it is collapsed on the page."""
        return len(self.rows) > LONG_ROWS

    def csv(self):
        """The bytes of a CSV file."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow([column.key for column in self.columns])
        for row in self.rows:
            writer.writerow([f"{cell:.6g}" if isinstance(cell, (int, float)) else cell for cell in row])
        return text.getvalue().encode("utf-8", "replace")
