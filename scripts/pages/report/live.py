# SPDX-License-Identifier: Apache-2.0
"""The live run: requested and measured rates, and where the time went."""
from dataclasses import dataclass

from pages.report.kinds import is_number

DATA_FLOW = ("camera", "camera2", "pose", "landmarks", "landmarks2", "projector", "projector2", "observer")
ENOUGH = 0.9  # share of a requested rate that a computer must hold

# The stages of ipc/msg/stage_mark.hpp in two groups, in their order.
STAGES = (
    ("One projector frame",
     "The steps in their order; frame: all of them; present: handing the frame to the projector; light: the time from there to the "
     "middle of its light.",
     ("predict", "mask", "register", "advance", "skin", "correct", "draw", "warp", "fill", "gpu_draw", "gpu_warp", "gpu_upload", "gpu_fill",
      "gpu_read", "frame", "present", "light")),
    ("Sensors",
     "capture and sample: the age of an image or pose when it is published; detect: the duration of a detection.",
     ("capture", "sample", "detect")),
)


@dataclass
class Service:
    """A row of the table of services."""
    name: str
    backend: str
    wanted_hz: float  # None: none
    held_hz: float
    restarts: str

    @property
    def share(self):
        """The share of the requested rate that was held; None if there is none."""
        return self.held_hz / self.wanted_hz if self.held_hz is not None and self.wanted_hz and self.wanted_hz > 0 else None


def text_of(value):
    """A word or a number of the supervisor; a dash if it is neither."""
    if is_number(value):
        return f"{value:.12g}"
    return value if isinstance(value, str) and value else "–"


def services_of(live):
    """The services in the order of the data flow, then all others."""
    services = live.value("services") or {}
    names = [name for name in DATA_FLOW if name in services] + sorted(set(services) - set(DATA_FLOW))
    return [Service(name, text_of(live.value("services", name, "backend")), live.number("rates", name, "wanted_hz"),
                    live.number("rates", name, "held_hz"), text_of(live.value("services", name, "restarts"))) for name in names]


def too_slow(live):
    """The least share of a rate that was held, if the computer was too slow for it; else None."""
    shares = [Service("", "", live.number("rates", name, "wanted_hz"), live.number("rates", name, "held_hz"), "").share
              for name in ("camera", "camera2", "projector", "projector2") if live.value("services", name, "is_held_to_its_rate") is not False]
    least = min((share for share in shares if share is not None), default=1)
    return least if least < ENOUGH else None


def slowest_of(live):
    """A sentence for each projector about what made its slowest frames slow; "" if nothing is known."""
    def sentence(projector):
        def count(key):
            return live.number("slow_frames", projector, key) or 0
        return (f"Of the {count('count'):.0f} slowest frames of {projector} ({count('least_us') / 1000:.2f} ms or more), "
                f"{count('preempted'):.0f} were preempted by other threads, {count('interrupted'):.0f} by interrupts or a hypervisor, "
                f"{count('page_faults'):.0f} had page faults, and {count('own'):.0f} were slow on the processor itself, by memory or its "
                "clock.")
    return " ".join(map(sentence, live.value("slow_frames") or ()))


@dataclass
class Time:
    """A bar of the sheet of times: median and 99th percentile in µs, and both in percent of the sheet's width, clipped at its edge."""
    name: str
    p50: float
    p99: float
    p50_percent: float
    p99_percent: float


def times_of(columns, stages):
    """Pairs of a stage and its bars, for the stages of which any column has a time. `columns`: pairs of a name and a source."""
    stages = [name for stage in stages for name in (stage, stage + "2")]  # of a second projector or camera
    known = [stage for stage in stages if any(source.number("stage_us", stage, "p50") is not None for _, source in columns)]
    full = max([1, *(1.35 * (source.number("stage_us", stage, "p50") or 0) for stage in known for _, source in columns)])

    def bars(stage):
        for name, source in columns:
            p50, p99 = (source.number("stage_us", stage, which) for which in ("p50", "p99"))
            if p50 is not None:
                yield Time(name, p50, p99, min(100, 100 * p50 / full), min(100, 100 * (p50 if p99 is None else p99) / full))

    return [(stage, list(bars(stage))) for stage in known]


def sheets_of(live, simulated):
    """Triples of a title, a sentence and times_of(), for the groups of stages of which there is a time."""
    columns = (("live", live), ("simulated", simulated))
    sheets = [(title, sentence, times_of(columns, stages)) for title, sentence, stages in STAGES]
    return [sheet for sheet in sheets if sheet[2]]
