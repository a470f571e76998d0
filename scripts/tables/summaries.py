# SPDX-License-Identifier: Apache-2.0
"""The short tables and sentences of README.md and docs/results.md about the results of whole tables."""

from tables.rows import BY_VARIANT
from tables.runs import interval
from tables.verdicts import pairs_of, verdict

# What makes the two methods of a pair comparable, in words of a table.
CONDITIONS = {
    "as published": "as published ({detector}, the paper's times)",
    "with our network for both": "our network, our times for both",
    "with MediaPipe for both": "MediaPipe, our times for both",
    "with the model for both": "the model of a detector, our times for both",
}


def condition(runs, words):
    detector = "MediaPipe" if "mediapipe" in runs.detector("paper") else "model of a detector"
    return CONDITIONS[words].format(detector=detector)


def people_of(runs, people):
    """How many people there are, of how many."""
    text = f"{len(runs.seeds)} simulated people"
    return text + (f" of {people} of the protocol" if len(runs.seeds) < people else "")


def readme(runs, people):
    """The table of the README and its sentence of doubt."""
    motions = {motion for _, motion in runs.motions}
    yield "| error of the light, mean / p95 mm | handcast | the paper's method | ratio | worse in (cases) |"
    yield "|---|---|---|---|---|"
    for ours, theirs, words in pairs_of(runs):
        count, of = runs.lost(ours, theirs)
        yield (f"| {condition(runs, words)} | {runs.both(ours, None)} | {runs.both(theirs, None)} | "
               f"{interval(runs.ratios_of_all(ours, theirs))} | {count} of {of} |")
    spill, of = runs.lost("handcast", "paper", "spill")
    yield ""
    yield (f"All of this is simulated ({len(motions)} motions on which nothing was tuned, {people_of(runs, people)} with hands of "
           f"{len(runs.meshes)} other meshes): the paper's method is our own implementation of it, our network was trained on renders of "
           f"hands like those that are drawn, more light falls beside the hand than with the paper's method in {spill} of {of} cases, and no "
           f"real device has been measured yet.")


def pairs(runs, people):
    """A row for each pair of methods, with the cells in which handcast is worse, and what the goals say."""
    yield ("| | handcast | the paper's method | ratio | larger mean in | largest ratio | larger p95 in | larger share dark or > 10 mm off in | "
           "more light beside the hand in |")
    yield "|---|---|---|---|---|---|---|---|---|"
    for ours, theirs, words in pairs_of(runs):
        count, of = runs.lost(ours, theirs)
        cells = [condition(runs, words), runs.both(ours, None), runs.both(theirs, None), interval(runs.ratios_of_all(ours, theirs)),
                 f"{count} of {of}", f"{runs.largest_ratio(ours, theirs):.2f}",
                 *(str(runs.lost(ours, theirs, name)[0]) for name in ("interior_mm_p95", "off_10mm", "spill"))]
        yield "| " + " | ".join(cells) + " |"
    yield ""
    yield f"{people_of(runs, people).capitalize()}; a cell is one {runs.cell_name()}."
    sentences = verdict(runs.part, runs)
    yield sentences[0]
    yield sentences[-1]


def unseen_pairs(runs, people):
    """The same, and the figures of each mesh."""
    yield from pairs(runs, people)
    notes = {"webxr": ", which our network has not seen,",
             "implicit": ", on which no constant was chosen, but whose like our network has seen,"}
    parts = []
    for mesh in runs.meshes:
        alone = runs.of_mesh(mesh)
        parts.append(f"on `{mesh}`{notes.get(mesh, '')} {alone.both('handcast', None)} mm, a ratio of "
                     f"{interval(alone.ratios_of_all('handcast', 'paper'))}")
    yield "By mesh: " + "; ".join(parts) + "."


def comparison_pairs(runs, people):
    """The same, and which motions are easy and which are hard."""
    yield from pairs(runs, people)
    easy, hard = ["still", "wave"], ["turn_pointing", "turn_fist"]
    if set(easy + hard) <= set(runs.motions):
        def span(variant, motions):
            means = [runs.mean(variant, motion, "interior_mm_mean") for motion in motions]
            least, most = f"{min(means):.1f}", f"{max(means):.1f}"
            return least if least == most else f"{least} to {most}"

        yield (f"Still and waving hands are {span('handcast', easy)} mm off, turning fists and pointing hands {span('handcast', hard)} mm "
               f"({span('paper_network', hard)} mm with the paper's method and our network).")


def levers_summary(runs, people):
    """What one lever after the other leaves of the paper's error."""
    rows = BY_VARIANT["levers"]
    parts = [f"{rows[variant][0].removeprefix('+ ').removesuffix(': handcast')} {interval(runs.ratios_of_all(variant, 'paper')).split(' ')[0]}"
             for variant in runs.variants if variant != "paper"]
    yield (f"Each lever is added to those before it and leaves this share of the error of the paper's cascade at our times, with "
           f"{'MediaPipe' if 'mediapipe' in runs.detector('paper') else 'a model of a detector'} at first ({people_of(runs, people)}): "
           f"{'; '.join(parts)}.")


# By name: the lines, and the table whose results they are about.
SUMMARIES = {
    "summary": (readme, "unseen"),
    "unseen_pairs": (unseen_pairs, "unseen"),
    "comparison_pairs": (comparison_pairs, "comparison"),
    "levers_summary": (levers_summary, "levers"),
}
