# SPDX-License-Identifier: Apache-2.0
"""Tests that each budget of scripts/budgets.py reports a planted breach, and nothing without one."""
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))
import budgets

TOPS = ["ipc", "services"]
SOURCE = "#pragma once\n" + "// a line\n" * 99


class Budgets(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("ipc/a.hpp", SOURCE)
        self.write("ipc/a.cpp", '#include "ipc/a.hpp"\n' + SOURCE)
        self.write("tests/a_test.cpp", '#include "ipc/a.hpp"\n')
        self.write("README.md", "short\n")

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def said(self):
        return "\n".join(budgets.breaches(self.root, TOPS))

    def test_a_small_tree_keeps_all_budgets(self):
        self.assertEqual(self.said(), "")

    def test_too_many_files_and_lines_of_the_show_are_reported(self):
        with mock.patch.object(budgets, "SHOW_FILES", 1), mock.patch.object(budgets, "SHOW_LINES", 150):
            self.assertIn("the show has 2 files", self.said())
            self.assertIn("the show has 201 lines", self.said())

    def test_tools_and_drivers_do_not_count_as_the_show(self):
        for name in ("services/tools/a.cpp", "services/lab/a.cpp", "services/camera/leap/a.cpp"):
            self.write(name, SOURCE)
        with mock.patch.object(budgets, "SHOW_FILES", 2):
            self.assertEqual(self.said(), "")

    def test_many_tiny_files_are_reported(self):
        for number in range(9):
            self.write(f"ipc/tiny_{number}.cpp", "// tiny\n")
        self.assertIn("the median source has 1 lines", self.said())

    def test_a_header_with_one_user_is_reported_unless_a_test_includes_it(self):
        self.write("ipc/b.hpp", SOURCE)
        self.write("ipc/c.cpp", '#include "ipc/b.hpp"\n' + SOURCE)
        with mock.patch.object(budgets, "UNFOLDED_HEADERS", 0):
            self.assertIn("ipc/b.hpp: only ipc/c.cpp includes it", self.said())
            self.write("tests/b_test.cpp", '#include "ipc/b.hpp"\n')
            self.assertEqual(self.said(), "")

    def test_a_long_header_with_one_user_may_stand_alone(self):
        self.write("ipc/b.cpp", '#include "ipc/b.hpp"\n' + SOURCE * 2)
        self.write("ipc/b.hpp", SOURCE)
        self.write("ipc/c.cpp", '#include "ipc/b.hpp"\n' + SOURCE * 2)
        with mock.patch.object(budgets, "UNFOLDED_HEADERS", 0):
            self.assertEqual(self.said(), "")

    def test_a_header_that_would_make_its_source_long_may_stand_alone(self):
        self.write("ipc/b.hpp", SOURCE)
        self.write("ipc/c.cpp", '#include "ipc/b.hpp"\n' + SOURCE * 2)
        with mock.patch.object(budgets, "UNFOLDED_HEADERS", 0):
            self.assertEqual(self.said(), "")

    def test_a_wide_line_of_a_document_is_reported_but_not_a_row_of_a_table(self):
        self.write("a.md", "x" * 121 + "\n|" + "x" * 200 + "|\n")
        self.assertIn("a.md:1: 121 columns", self.said())
        self.assertNotIn("a.md:2", self.said())

    def test_long_documents_are_reported(self):
        self.write("README.md", "a line\n" * 121)
        self.write("DECISIONS.md", "## Short\n" + "line\n" * 6 + "## Long\n" + "line\n" * 7)
        self.assertIn("README.md has 121 lines", self.said())
        self.assertIn("'Long' has 7 lines", self.said())
        self.assertNotIn("'Short'", self.said())
        with mock.patch.object(budgets, "DOCUMENT_WORDS", 100):
            self.assertIn("the documents have", self.said())


if __name__ == "__main__":
    unittest.main()
