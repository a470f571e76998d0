# SPDX-License-Identifier: Apache-2.0
"""handcast report: metrics.json, preview.mp4 and report.html, from the files of a demonstration and into the same folder."""
import json
import pathlib

from pages.document import now, page_of, this_machine
from pages.files import write_whole
from pages.report.accuracy import METRICS, detector_of, replaced_detectors, row_of
from pages.report.film import make_film
from pages.report.inputs import gather_metrics, read_inputs
from pages.report.live import services_of, sheets_of, slowest_of, too_slow
from pages.report.speed import bins_of, chart_of

DONE, BAD_RESULT = 0, 1


def stated(inputs, key):
    """A setting, from the first run that has it; "" if none has."""
    values = (run.metrics.value(key) for run in inputs.runs)
    value = next((value for value in values if value is not None), "")
    return value if isinstance(value, str) else json.dumps(value)


def facts_of(inputs):
    """What was run, where and when."""
    rigs = [run.metrics.value("rig") for run in inputs.runs]
    seconds = stated(inputs, "seconds")
    return [("rigs", ", ".join(filter(None, rigs))), ("motion", stated(inputs, "motion")),
            ("scored", seconds and f"{seconds} s"), ("seed", stated(inputs, "seed")), ("machine", this_machine()), ("made", now())]


def page(inputs, film, title):
    """The bytes of report.html."""
    bins = bins_of(inputs.runs)
    return page_of("report.html", title, facts_of(inputs), inputs=inputs, runs=inputs.runs, film=film,
                   metrics=[row_of(metric, inputs.runs) for metric in METRICS], detectors=[detector_of(run) for run in inputs.runs],
                   replaced=replaced_detectors(inputs.runs), bins=bins, chart=chart_of(inputs.runs, bins),
                   services=services_of(inputs.live), slow=too_slow(inputs.live), slowest=slowest_of(inputs.live),
                   sheets=sheets_of(inputs.live, inputs.runs[2].metrics))


def run(values, complain):
    """The verb. Exit code 1: a file is there and cannot be used."""
    folder = pathlib.Path(values.out)
    inputs = read_inputs(folder)
    film = make_film(inputs, folder / "preview.mp4")
    write_whole(folder / "metrics.json", gather_metrics(inputs))
    write_whole(folder / "report.html", page(inputs, film, values.title))
    print(folder / "report.html")
    for fault in inputs.faults():
        complain(BAD_RESULT, fault)
    return BAD_RESULT if inputs.faults() else DONE
