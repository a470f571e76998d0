#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the Python module makes of hands, without a rig."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import handcast  # noqa: E402

POINTS = [[1, 2]] * handcast.LANDMARKS


class Rows(unittest.TestCase):
    def test_are_of_the_hands_that_are_there(self):
        rows = handcast.landmark_rows({"right": POINTS, "left": None}, 5, 9)
        self.assertEqual([list(row[:8]) for row in rows], [[5, 9, 1, 1, 1, 2, 1, 0]])
        self.assertEqual([row[2] for row in handcast.landmark_rows({}, 5, 9)], [-1])

    def test_of_a_hand_that_does_not_exist_are_refused(self):
        for hands in ({"Left": POINTS}, {"left": POINTS, 1: POINTS}):
            with self.assertRaisesRegex(ValueError, "there is no hand"):
                handcast.landmark_rows(hands, 5, 9)

    def test_of_points_of_another_shape_are_refused(self):
        for points in (POINTS[1:], [1.0] * 63, [[1, 2, 3]] * handcast.LANDMARKS):
            with self.assertRaisesRegex(ValueError, "landmarks must be 21 x 2, not "):
                handcast.landmark_rows({"left": points}, 5, 9)
        with self.assertRaisesRegex(ValueError, "one is NaN or infinite"):
            handcast.landmark_rows({"left": [[float("nan"), 2]] * handcast.LANDMARKS}, 5, 9)


if __name__ == "__main__":
    unittest.main()
