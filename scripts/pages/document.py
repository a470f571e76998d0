# SPDX-License-Identifier: Apache-2.0
"""Self-contained HTML pages, from the templates of this folder."""
import base64
import math
import os
import pathlib
import platform
import time

import jinja2


def figure(value, digits):
    """A number with `digits` decimals; a dash if it is missing or not finite."""
    return f"{value:.{digits}f}" if value is not None and math.isfinite(value) else "–"


def percent(share, digits):
    """A share in percent, without the sign; a dash if it is missing."""
    return figure(None if share is None else 100 * share, digits)


def data_url(kind, content):
    """The address of a file that is embedded in the page."""
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def environment():
    """Templates escape what they are given, and refuse names that they are not given."""
    made = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).parent / "templates"), autoescape=True,
                              undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters.update(figure=figure, percent=percent)
    return made


def page_of(template, title, facts, **values):
    """The bytes of a page. `facts`: pairs of a name and a value, of which empty ones are left out."""
    facts = [(name, value) for name, value in facts if value]
    text = environment().get_template(template).render(title=title, facts=facts, **values)
    return text.encode("utf-8", "replace")


def processor():
    """The name of this processor."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, "unknown processor")


def this_machine():
    """"AMD EPYC, 2 cores, Debian GNU/Linux 12 (bookworm)"."""
    cores = len(os.sched_getaffinity(0))
    try:
        system = platform.freedesktop_os_release().get("PRETTY_NAME", "")
    except OSError:
        system = ""
    return ", ".join(filter(None, [processor(), f"{cores} core{'' if cores == 1 else 's'}", system]))


def now():
    """"2025-11-21 12:00 UTC"."""
    return time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())
