# SPDX-License-Identifier: Apache-2.0
"""handcast benchmark: runs its plans, and writes benchmark.json, benchmark.md and benchmark.html with charts A and B."""
import pathlib
import re
import signal
import subprocess
import sys

from pages.benchmark.plans import MOST_PEOPLE, PLANS, Row, folder_of_plans, write_plan
from pages.benchmark.table import as_json, chart_of, markdown, rows_of
from pages.chart.chart_a import chart_a
from pages.chart.chart_b import chart_b
from pages.chart.results import read_results
from pages.chart.write import drawing_of, make_folder, page, write_drawing
from pages.document import now, this_machine
from pages.files import Problem, write_whole

DONE, SOME_FAILED = 0, 1


def number_of(values, key, most):
    """An option that is a whole number from 1 on; 0 if it is not given. Raises Problem."""
    text = getattr(values, key)
    if text is None:
        return 0
    if not re.fullmatch(r"\d{1,9}", text) or not 1 <= int(text) <= most:
        raise Problem(f"--{key} {text}: must be a whole number from 1 to {most}")
    return int(text)


def row_of(values):
    """The method whose results are in files; None if there is none. Raises Problem."""
    given = [part for part in ("landmarks", "poses") if getattr(values, part)]
    if len(given) > 1:
        raise Problem("a row is either of --landmarks or of --poses")
    if given and values.images:
        raise Problem(f"--images scores nothing: call it without --{given[0]}")
    if not given and values.name:
        raise Problem("--name is that of a row: add --landmarks or --poses")
    return Row(given[0], getattr(values, given[0]), values.name or "mine") if given else None


def sweep(*arguments):
    """Runs `handcast sweep`. Runs that fail or are left out are named by it. Raises Problem if there is no result at all."""
    program = pathlib.Path(sys.argv[0]).resolve().parent / "handcast-sweep"
    try:
        code = subprocess.run([program, *map(str, arguments)]).returncode
    except OSError as error:
        raise Problem(f"{program}: cannot be started: {error.strerror}") from None
    if code not in (DONE, SOME_FAILED):
        raise Problem(f"handcast sweep ended with {code}", may_pass=True)


def record(folder, people, out, jobs):
    """Writes the images, times and true hands of all cases."""
    make_folder(out)
    for name in PLANS:
        plan = write_plan(name, folder, people, out, only_cases=True)
        sweep(plan, "--record", out / name, "-o", out / f"{name}.csv", "--fresh", *jobs)
    print(out)


def score(folder, people, out, row, jobs):
    """Runs the plans and returns their results."""
    files = []
    for name in PLANS:
        files.append(out / f"{name}.csv")
        sweep(write_plan(name, folder, people, out, row), "-o", files[-1], "--fresh", *jobs)
    return read_results(files)


def write(results, out, title):
    """Writes the table, the numbers and the page."""
    rows = rows_of(results)
    source = next(source for source in results.sources if source.plan == PLANS[0])
    planned = source.planned // max(len(rows), 1)
    facts = {"made": now(), "machine": this_machine(), "failed": source.failed}
    write_whole(out / "benchmark.json", as_json(rows, planned, facts))
    table = "\n".join(markdown(rows)) + "\n"
    write_whole(out / "benchmark.md", table.encode())
    drawings = [drawing_of(chart) for chart in (chart_of(rows, planned), chart_a(results), chart_b(results))]
    for drawing in drawings:
        if drawing.light:
            write_drawing(out, drawing)
    write_whole(out / "benchmark.html", page(results, drawings, title))
    print(table + str(out / "benchmark.html"))


def run(values, complain):
    """The verb."""
    folder, people = folder_of_plans(values.plans), number_of(values, "people", MOST_PEOPLE)
    jobs = ["-j", str(count)] if (count := number_of(values, "jobs", 4096)) else []
    row, out = row_of(values), pathlib.Path(values.out).resolve()
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))  # then subprocess.run() ends the sweep
    if values.images:
        record(folder, people, pathlib.Path(values.images).resolve(), jobs)
        return DONE
    make_folder(out)
    write(score(folder, people, out, row, jobs), out, values.title)
    return DONE
