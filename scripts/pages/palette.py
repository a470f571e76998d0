# SPDX-License-Identifier: Apache-2.0
"""The colours of pages and charts, in the light and the dark colour scheme: those of templates/page.css.

    paper, panel, ink, quiet, line   surfaces, text and lines
    near, far                        bands of unnoticed delay, without and with the fill
    baseline, cascade, ours, fast    methods; they also differ in lightness, for readers who cannot distinguish the hues
"""
import pathlib
import re

STYLE = (pathlib.Path(__file__).parent / "templates/page.css").read_text(encoding="utf-8")
LIGHT, DARK = (dict(re.findall(r"--(\w+): (#\w{6});", part)) for part in STYLE.split("@media (prefers-color-scheme: dark)"))
