#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges the goals written by benchmarks and prints them as a table.

usage: goals.py [--json FILE] [--strict] GOALS.json...

Each file is {"goals": [{"name", "value", "limit", "unit", "met"}, ...]}; "met" defaults to value <= limit.
Exit 1 with --strict if a goal is missed.
"""
import argparse
import json
import pathlib
import sys


def read(file):
    goals = json.loads(pathlib.Path(file).read_text())["goals"]
    for goal in goals:
        goal.setdefault("met", goal["value"] <= goal["limit"])
    return goals


def table(goals):
    rows = [("goal", "value", "limit", "unit", "")]
    for goal in goals:
        verdict = "met" if goal["met"] else "missed"
        rows.append((goal["name"], f"{goal['value']:.4g}", f"{goal['limit']:.4g}", goal.get("unit", ""), verdict))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    aligned = ("<", ">", ">", "<", "<")
    return "\n".join("  ".join(f"{cell:{a}{w}}" for cell, a, w in zip(row, aligned, widths)).rstrip() for row in rows)


def main():
    parser = argparse.ArgumentParser(description="Merges the goals written by benchmarks and prints them as a table.")
    parser.add_argument("--json", metavar="FILE", help="also writes the merged goals to FILE")
    parser.add_argument("--strict", action="store_true", help="fails if a goal is missed")
    parser.add_argument("files", nargs="+", metavar="GOALS.json")
    options = parser.parse_args()
    goals = [goal for file in options.files for goal in read(file)]
    if options.json:
        file = pathlib.Path(options.json)
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps({"goals": goals}, indent=2) + "\n")
    print(table(goals))
    return 1 if options.strict and not all(goal["met"] for goal in goals) else 0


if __name__ == "__main__":
    sys.exit(main())
