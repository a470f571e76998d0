#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of a sweep as a table, or as sentences, into a document.

    results_table.py PART RESULTS.csv DOCUMENT.md [COMMAND [PEOPLE]]

PART is a table of scripts/results (comparison, unseen, levers, fidelity, causes, motions, fast, two_hands, jitter, first_seconds,
no_tracker), or summary or unseen_summary: sentences about the results of comparison and unseen. They replace what stands between the
lines "<!-- PART: begin -->" and "<!-- PART: end -->". COMMAND is named below the table as what has made it, and PEOPLE is the number
of seeds that the protocol asks for: a table of fewer says so. scripts/results calls this program.
"""

import os
import statistics
import sys

from sweep_runs import Runs, die, interval, listed

# docs/method.md#goals. The first two are parts of the paper's error.
GOAL, GOAL_FAST, GOAL_MM = 0.45, 0.5, (1.8, 4.0)
GOAL_COVERAGE, GOAL_SPILL, GOAL_LATENCY_MS, GOAL_JITTER_PX, GOAL_TWO_HANDS = 0.99, 0.01, 6.6, 0.5, 1.1

# A row of a table by variants: its label, and the variant to whose error its own is compared ("" for none).
BY_VARIANT = {
    "comparison": {
        "baseline": ("baseline", "paper"),
        "paper": ("paper, as published", ""),
        "paper_network": ("paper, our times", "paper"),
        "handcast": ("**handcast**", "paper_network"),
        "paper_mediapipe": ("paper, our times", "paper"),
        "handcast_mediapipe": ("handcast", "paper_mediapipe"),
        "paper_model": ("paper, our times", "paper"),
        "handcast_model": ("handcast", "paper_model"),
    },
    "levers": {
        "paper": ("paper, at our times", ""),
        "bone_fit": ("+ bone fit", "paper"),
        "widths": ("+ widths", "paper"),
        "offset_filter": ("+ offset filter", "paper"),
        "vertices": ("+ vertices, moved mask, longer fill", "paper"),
        "registration": ("+ late registration", "paper"),
        "network": ("+ our network", "paper"),
        "learned": ("+ learned turn and definitions", "paper"),
        "outline": ("+ outline of open hands", "paper"),
        "gate": ("+ gate, acceleration, held snaps: handcast", "paper"),
    },
    "two_hands": {
        "left": ("left hand alone", ""),
        "right": ("right hand alone", ""),
        "both": ("both", ""),
    },
    "fidelity": {
        "paper": ("21 points, both hands", ""),
        "released_points": ("16 points", "paper"),
        "one_hand": ("off for two hands", "paper"),
        "as_released": ("both, as released", "paper"),
        "longer_fill": ("fills up to 32 px", "paper"),
        "released_seam": ("seams from 0.5 of the texture on, as released", "paper"),
    },
    "causes": {
        "all_errors": ("all errors", ""),
        "without_turn": ("all errors, without `skin.turn`", "all_errors"),
        "our_mesh": ("without the shape of other hands", "all_errors"),
        "right_place": ("without the tracker's place, turn and size", "all_errors"),
        "right_joints": ("without the tracker's joints at other places", "all_errors"),
        "right_flexion": ("without its errors in flexion, and its lag", "all_errors"),
        "right_calibration": ("without the errors of the calibration", "all_errors"),
        "clear_images": ("with bright skin on an empty background", "all_errors"),
        "right_clocks": ("without the errors of clocks, and losses", "all_errors"),
        "perfect_sensors": ("perfect sensors, WebXR's hand", "all_errors"),
        "perfect_sensors_our_mesh": ("perfect sensors, our own mesh", "all_errors"),
    },
}
BY_VARIANT["first_seconds"] = {variant: BY_VARIANT["comparison"][variant] for variant in ("paper", "paper_network", "handcast")}
JITTER = {variant: BY_VARIANT["comparison"][variant] for variant in
          ("baseline", "paper", "paper_network", "handcast", "handcast_mediapipe")}
# What has real detectors, on motions that nothing was tuned on: a table for each mesh.
BY_VARIANT["unseen"] = {variant: row for variant, row in BY_VARIANT["comparison"].items() if not variant.endswith("_model")}
# Tables by motion: the variants of the columns, and the one to whose error the last one's is compared.
BY_MOTION = {
    "motions": (["baseline", "paper", "handcast"], "paper"),
    "fast": (["baseline", "paper", "handcast"], "paper"),
    "no_tracker": (["baseline", "handcast", "no_tracker"], "handcast"),
}


def footer(runs, command, people):
    text = f"Seeds {listed(runs.seeds)}"
    text += f": {len(runs.seeds)} of the {people} people of the protocol." if len(runs.seeds) < people else "."
    if command:
        text += f" Made by `{command}`."
    if command.endswith("--quick"):
        text += " Quick: two motions of 1 s, after 0.5 s in which a rig learns."
    yield ""
    yield text
    if runs.left_out:
        yield f"Left out, because runs failed: the seeds {listed(runs.left_out)}."
    if runs.missing:
        yield f"{runs.missing} runs of the plan are absent: recordings or hands were not there, or the sweep was interrupted."
    for variant in runs.absent:
        yield f"`{variant}` was not measured: {runs.errors.get(variant) or 'it has no runs'}."


def table_by_variant(part, runs):
    """A row for each variant, a column for each motion."""
    names = [motion[1] if isinstance(motion, tuple) else motion for motion in runs.motions]
    yield "| | detector | " + " | ".join(names) + " | all | lit points alone | dark, % | dark or > 10 mm off, % | ratio | to |"
    yield "|" + "---|" * (len(runs.motions) + 8)
    for variant in runs.variants:
        label, reference = BY_VARIANT[part][variant]
        ratio = ["", ""]
        if runs.has(reference):
            ratio = [interval(runs.ratios_of_all(variant, reference)), BY_VARIANT[part][reference][0].strip("*")]
            if BY_VARIANT[part][reference][0] == "paper, our times":
                ratio[1] += ", the same detector"
        detector = "" if variant == "baseline" else runs.detector(variant)
        cells = [label, detector, *(runs.both(variant, motion) for motion in runs.motions), runs.both(variant, None),
                 runs.both(variant, None, "lit"), *(percent(runs, variant, name) for name in ("missing", "off_10mm")), *ratio]
        yield "| " + " | ".join(cells) + " |"


def percent(runs, variant, name):
    """The mean of a share over all motions and seeds, in percent."""
    return f"{100 * runs.mean(variant, None, name):.1f}"


def table_by_motion(part, runs):
    """A row for each motion, a column for each variant."""
    variants, reference = BY_MOTION[part]
    last = variants[-1]
    for variant in variants:
        if not runs.has(variant):
            die(f"{variant} has no runs")
    yield ("| motion | " + " | ".join(f"{variant} ({runs.detector(variant)})" if variant != "baseline" else variant
                                      for variant in variants) +
           f" | ratio, {last} to {reference} | coverage / spill, %: " + " | ".join(variants) + " |")
    yield "|" + "---|" * (2 * len(variants) + 2)
    for motion in runs.motions:
        light = [f"{100 * runs.mean(variant, motion, 'coverage'):.1f} / {100 * runs.mean(variant, motion, 'spill'):.1f}"
                 for variant in variants]
        cells = [motion, *(runs.both(variant, motion) for variant in variants),
                 interval(runs.ratios(last, reference, motion)), *light]
        yield "| " + " | ".join(cells) + " |"
    cells = ["all", *(runs.both(variant, None) for variant in variants), interval(runs.ratios_of_all(last, reference))]
    yield "| " + " | ".join(cells) + " |" + " |" * len(variants)


def cells_of(runs):
    """What the cells of a table are."""
    return "mesh, motion and seed" if runs.meshes else "motion and seed"


def lost(runs, ours, theirs, name="interior_mm_mean"):
    """In how many cells `ours` has the larger figure, of how many, and the largest ratio of the mean errors."""
    pairs = [pair for motion in runs.motions for pair in zip(runs.of(ours, motion, name), runs.of(theirs, motion, name))]
    return sum(a > b for a, b in pairs), len(pairs), max(runs.cells(ours, theirs))


def lost_cells(runs, variant, reference):
    count, of, most = lost(runs, variant, reference)
    return f"{count} of {of} cells of {cells_of(runs)} (largest ratio {most:.2f})"


# Pairs of variants that a table compares, and what makes them comparable.
PAIRS = [("handcast", "paper", "as published"), ("handcast", "paper_network", "with our network for both"),
         ("handcast_mediapipe", "paper_mediapipe", "with MediaPipe for both"),
         ("handcast_model", "paper_model", "with the model for both")]


def verdict(runs):
    """What the comparison says about the goals, and where handcast is worse than the paper's cascade."""
    yield ""
    mean, p95 = (runs.mean("handcast", None, f"interior_mm_{of}") for of in ("mean", "p95"))
    ratios = runs.ratios_of_all("handcast", "paper")
    yield (f"handcast to the paper's cascade as published: {interval(ratios)}; the goal of {GOAL} is "
           f"{reached(statistics.fmean(ratios) <= GOAL)}. {mean:.1f} / {p95:.1f} mm; the goal of {GOAL_MM[0]} / {GOAL_MM[1]} mm is "
           f"{reached(mean <= GOAL_MM[0] and p95 <= GOAL_MM[1])}. "
           f"By the lit points alone, the ratio is {interval(runs.ratios_of_all('handcast', 'paper', 'lit_mm_mean'))}. "
           f"Dark or more than 10 mm off: {percent(runs, 'handcast', 'off_10mm')} % of the skin, {percent(runs, 'paper', 'off_10mm')} % with "
           "the paper's cascade.")
    pairs = [pair for pair in PAIRS if runs.has(pair[0]) and runs.has(pair[1])]
    yield "The mean error of handcast is larger: " + "; ".join(
        f"{words}, in {lost_cells(runs, ours, theirs)}" for ours, theirs, words in pairs) + "."
    yield "In the same order, " + "; ".join(
        f"its {words} is larger in {listing([lost(runs, ours, theirs, name)[0] for ours, theirs, _ in pairs])} cells"
        for name, words in (("interior_mm_p95", "p95"), ("missing", "dark share"), ("spill", "spill"))) + "."
    yield light_verdict(runs)


def listing(values):
    """1, 2 and 3."""
    texts = [str(value) for value in values]
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if len(texts) > 1 else texts)


def light_verdict(runs):
    """What the light of handcast says about the goals of coverage, spill and fold-overs."""
    light = [cell for motion in runs.motions
             for cell in zip(*(runs.of("handcast", motion, name) for name in ("coverage", "spill", "foldovers")))]
    return (f"Coverage of handcast is below the goal of {100 * GOAL_COVERAGE:.0f} % in {sum(c < GOAL_COVERAGE for c, _, _ in light)} of "
            f"{len(light)} runs (least {100 * min(c for c, _, _ in light):.1f} %), its spill above the goal of {100 * GOAL_SPILL:.0f} % in "
            f"{sum(s > GOAL_SPILL for _, s, _ in light)} (most {100 * max(s for _, s, _ in light):.1f} %). Its drawing has fold-overs in "
            f"{sum(f > 0 for _, _, f in light)} of them (goal: none).")


def reached(is_reached):
    return "reached" if is_reached else "missed"


def verdict_of_motions(runs):
    """Where handcast is worse than the paper's cascade, and what its light says."""
    yield ""
    yield f"The mean error of handcast is larger than that of the paper's cascade in {lost_cells(runs, 'handcast', 'paper')}."
    yield light_verdict(runs)


def verdict_of_fast(runs):
    """What motions three times as fast say about the goals."""
    ratios = runs.ratios_of_all("handcast", "paper")
    delays = [delay for motion in runs.motions for delay in runs.of("handcast", motion, "equivalent_latency_ms")]
    late = sum(abs(delay) > GOAL_LATENCY_MS for delay in delays)
    yield from verdict_of_motions(runs)
    yield (f"handcast to the paper's cascade: {interval(ratios)}; the goal of {GOAL_FAST} is "
           f"{reached(statistics.fmean(ratios) <= GOAL_FAST)}. The equivalent latency of handcast is {statistics.median(delays):.1f} ms in the "
           f"median ({min(delays):.1f} to {max(delays):.1f}); {len(delays) - late} of {len(delays)} runs are within the goal of "
           f"{GOAL_LATENCY_MS} ms.")


def verdict_of_causes(runs):
    """What perfect sensors would bring, and what the calibration costs in coverage."""
    mean, p95 = (runs.mean("perfect_sensors", None, f"interior_mm_{of}") for of in ("mean", "p95"))
    better = "reach it" if mean <= GOAL_MM[0] and p95 <= GOAL_MM[1] else "do not reach it"
    coverage = [f"{100 * runs.mean(variant, None, 'coverage'):.1f} % with {words}" for variant, words in
                (("all_errors", "all errors"), ("right_calibration", "a right calibration"), ("perfect_sensors", "perfect sensors"))]
    yield ""
    yield (f"The goal is {GOAL_MM[0]} / {GOAL_MM[1]} mm. Perfect sensors alone ({mean:.1f} / {p95:.1f} mm) {better}. Coverage: "
           f"{', '.join(coverage)}; the goal is {100 * GOAL_COVERAGE:.0f} %.")


def only_motion(runs):
    if len(runs.motions) != 1:
        die(f"this table is of one motion, and the runs are of {len(runs.motions)}")
    return runs.motions[0]


def verdict_of_two_hands(runs):
    """How much worse two hands are than the same hands alone."""
    motion = only_motion(runs)
    ratios = [2 * both / (left + right) for left, right, both in
              zip(*(runs.of(variant, motion, "interior_mm_mean") for variant in ("left", "right", "both")))]
    yield ""
    yield (f"Both hands to the mean of each alone: {interval(ratios)}; the goal of {GOAL_TWO_HANDS} is "
           f"{reached(statistics.fmean(ratios) <= GOAL_TWO_HANDS)}.")


def table_of_jitter(runs):
    """A row for each variant, and what handcast says about the goal."""
    motion = only_motion(runs)
    yield "| | detector | the light, px RMS | each person |"
    yield "|---|---|---|---|"
    for variant in runs.variants:
        detector = "" if variant == "baseline" else runs.detector(variant)
        yield (f"| {JITTER[variant][0]} | {detector} | {interval(runs.of(variant, motion, 'jitter_px'))} | "
               f"{', '.join(f'{px:.2f}' for px in runs.of(variant, motion, 'jitter_px'))} |")
    if not all(runs.has(variant) for variant in NEEDED["jitter"]):
        return
    yield ""
    yield (f"The goal of {GOAL_JITTER_PX} px is {reached(runs.mean('handcast', motion, 'jitter_px') <= GOAL_JITTER_PX)} with our network.")


def larger_in(runs):
    """In how many cells the mean error of handcast is larger, for the pairs that have runs."""
    texts = []
    for ours, theirs, words in PAIRS:
        if not (runs.has(ours) and runs.has(theirs)):
            continue
        count, of, most = lost(runs, ours, theirs)
        cells = f"{count} of {of} cells of {cells_of(runs)}" if not texts else str(count)
        texts.append(f"in {cells} {words} (largest ratio {most:.2f})")
    return "The mean error of handcast is larger " + ", ".join(texts) + "."


def people_of(runs, people):
    text = f"{len(runs.seeds)} simulated people, each with other errors of the rig"
    return text + (f"; the protocol asks for {people}" if len(runs.seeds) < people else "")


def headline(runs, people):
    """The errors of both methods, their ratios, and where handcast is worse."""
    ours, theirs = runs.both("handcast", None), runs.both("paper", None)
    ratio, same = (interval(runs.ratios_of_all("handcast", reference)) for reference in ("paper", "paper_network"))
    return (f"the light of handcast is {ours} mm (mean / p95) from its place with our network; that of the published method, as we wrote it anew, is "
            f"{theirs} mm off with {'MediaPipe' if 'mediapipe' in runs.detector('paper') else 'a model of a detector'} and its own times. The "
            f"ratio is {ratio} (95 % over the {people_of(runs, people)}), and {same} with our network and our times for both. " +
            larger_in(runs))


def summary(runs, people):
    """The sentences of the README about motions on which constants were chosen."""
    yield f"On {len(runs.motions)} motions on which constants were chosen, " + headline(runs, people)
    easy, hard = ["still", "wave"], ["turn_pointing", "turn_fist"]
    if set(easy + hard) <= set(runs.motions):
        def span(variant, motions):
            means = [runs.mean(variant, motion, "interior_mm_mean") for motion in motions]
            least, most = f"{min(means):.1f}", f"{max(means):.1f}"
            return least if least == most else f"{least} to {most}"

        yield (f"Still and waving hands are {span('handcast', easy)} mm off, turning fists and pointing hands {span('handcast', hard)} mm "
               f"({span('paper_network', hard)} mm with the published method and our network).")


def unseen_summary(runs, people):
    """The sentences of the README about motions that nothing was tuned on."""
    motions = {motion for _, motion in runs.motions}
    yield (f"In a simulated careful installation, on {len(motions)} motions that nothing was tuned on, with true hands of "
           f"{len(runs.meshes)} meshes that are not the drawn one, " + headline(runs, people))
    for mesh in runs.meshes:
        if mesh == "implicit":
            alone = runs.of_mesh(mesh)
            yield (f"On the one of these meshes that nothing was tuned on, it is {alone.both('handcast', None)} mm, a ratio of "
                   f"{interval(alone.ratios_of_all('handcast', 'paper'))}.")


def unseen_tables(runs):
    """A table for each mesh, and what both say."""
    for mesh in runs.meshes:
        yield f"True hands of the mesh `{mesh}`:"
        yield ""
        yield from table_by_variant("unseen", runs.of_mesh(mesh))
        yield ""
    yield "All meshes together:"
    yield from verdict(runs)


# The variants without which nothing is said below a table.
NEEDED = {"causes": ("all_errors", "right_calibration", "perfect_sensors"), "two_hands": ("left", "right", "both"),
          "jitter": ("handcast",)}
# What is said below a table.
VERDICTS = {"comparison": verdict, "causes": verdict_of_causes, "two_hands": verdict_of_two_hands, "motions": verdict_of_motions,
            "fast": verdict_of_fast}


def check_headline(path, runs):
    """Ends the program if runs are absent of which the first sentences speak."""
    if runs.missing:
        die(f"{path} lacks {runs.missing} runs of its plan: recordings or hands were not there, or the sweep was interrupted")
    for variant in ("paper", "paper_network", "handcast"):
        if not runs.has(variant):
            die(f"{path} has no runs of {variant}")


def lines_of(part, path, command, people):
    if part == "unseen_summary":
        runs = Runs(path, [*BY_VARIANT["unseen"]], "unseen")
        check_headline(path, runs)
        if not runs.meshes:
            die(f"{path} has no runs of several meshes")
        return list(unseen_summary(runs, people))
    if part == "summary":
        runs = Runs(path, [*BY_VARIANT["comparison"]], "comparison")
        check_headline(path, runs)
        return list(summary(runs, people))
    if part in BY_VARIANT:
        runs = Runs(path, BY_VARIANT[part], part)
        if part in ("comparison", "unseen", "first_seconds"):
            check_headline(path, runs)
        lines = list(unseen_tables(runs) if part == "unseen" else table_by_variant(part, runs))
        if part in VERDICTS and all(runs.has(variant) for variant in NEEDED.get(part, ())):
            lines += VERDICTS[part](runs)
    elif part in BY_MOTION:
        runs = Runs(path, BY_MOTION[part][0], part)
        lines = list(table_by_motion(part, runs))
        if part in VERDICTS:
            lines += VERDICTS[part](runs)
    elif part == "jitter":
        runs = Runs(path, JITTER, part)
        lines = list(table_of_jitter(runs))
    else:
        die(f"there is no table '{part}'; there are: {', '.join([*BY_VARIANT, *BY_MOTION, 'jitter', 'summary', 'unseen_summary'])}")
    return lines + list(footer(runs, command, people))


def replaced(document, part, lines):
    """The text of a document with these lines between the marks of `part`."""
    try:
        with open(document, newline="", encoding="utf-8") as file:
            text = file.read()
    except (OSError, UnicodeDecodeError) as error:
        die(f"{document} cannot be read: {error}")
    begin, end = f"<!-- {part}: begin -->", f"<!-- {part}: end -->"
    if text.count(begin) != 1 or text.count(end) != 1 or text.index(end) < text.index(begin):
        die(f"{document} must have the lines {begin} and {end}, each once and in this order")
    before, rest = text.split(begin)
    old, after = rest.split(end)
    if "<!-- " in old:
        die(f"{document} has other marks between {begin} and {end}")
    newline = "\r\n" if "\r\n" in text else "\n"
    return before + begin + newline + newline.join(lines) + newline + end + after


def write_whole(document, text):
    """Replaces a file by a text as a whole: if that fails, the old one is untouched."""
    beside = f"{document}.new"
    try:
        with open(beside, "w", newline="", encoding="utf-8") as file:
            file.write(text)
        os.chmod(beside, os.stat(document).st_mode & 0o7777)
        os.replace(beside, document)
    except OSError as error:
        if os.path.exists(beside):
            os.remove(beside)
        die(f"{document} cannot be written: {error}")


def main():
    if len(sys.argv) not in (4, 5, 6) or "-h" in sys.argv or "--help" in sys.argv:
        sys.exit(__doc__)
    part, results, document = sys.argv[1:4]
    command = sys.argv[4] if len(sys.argv) > 4 else ""
    people = sys.argv[5] if len(sys.argv) > 5 else "0"
    if not people.isdecimal():
        die(f"PEOPLE must be a number, and not '{people}'")
    write_whole(document, replaced(document, part, lines_of(part, results, command, int(people))))


main()
