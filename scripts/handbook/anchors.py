# SPDX-License-Identifier: Apache-2.0
"""The anchors of headings, as viewers of Markdown make them."""
import re


def anchor_of(heading):
    """The anchor of a heading in Markdown, without the `#`."""
    text = re.sub(r"[`*]", "", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
