# SPDX-License-Identifier: Apache-2.0
"""Each finding of the doctor is on docs/operating/trouble.md, and no other. The names are read in the doctor's sources."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCTOR = "services/tools/doctor"
PAGE = "docs/operating/trouble.md"
NAMES = re.compile(r'"([a-z0-9 ]+)",\s*Grade::|judge_rate\([^;]*?, "([a-z ]+)", "|kSoftware = "([a-z ]+)"')
# Names that are put together from that of the setting or the service.
PUT_TOGETHER = {"camera device", "camera2 device", "projector rate", "light of projector"}


def names_in_sources():
    code = "".join(path.read_text(encoding="utf-8") for path in sorted((ROOT / DOCTOR).glob("*.cpp")))
    return {name for names in NAMES.findall(code) for name in names if name}


def names_on_page():
    """The names in the first cells of the last table; those of the other one are examples."""
    page = (ROOT / PAGE).read_text(encoding="utf-8")
    cells = re.findall(r"^\| (`.*?) \|", page.partition("## What the doctor finds")[2], re.M)
    return {name for cell in cells for name in re.findall(r"`([^`]+)`", cell)}


class Findings(unittest.TestCase):
    def test_each_is_on_the_page(self):
        self.assertGreater(len(names_in_sources()), 25)
        self.assertEqual(names_in_sources() - names_on_page(), set())

    def test_no_other_is_on_the_page(self):
        self.assertEqual(names_on_page() - names_in_sources() - PUT_TOGETHER, set())

    def test_what_a_person_sees_leads_to_findings_that_there_are(self):
        table = (ROOT / PAGE).read_text(encoding="utf-8").partition("## What the doctor finds")[0]
        told = {name for row in re.findall(r"^\|[^|]*\| ([^|]*`[^|]*)\|", table, re.M) for name in re.findall(r"`([^`]+)`", row)}
        self.assertGreater(len(told), 15)
        self.assertEqual(told - names_on_page(), set())


if __name__ == "__main__":
    unittest.main()
