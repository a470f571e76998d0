# SPDX-License-Identifier: Apache-2.0
"""The rows and columns of the tables of docs/lab/results_tables.md."""

from tables.runs import interval, listed

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
        "vertices": ("+ vertices, moved mask, longer fill", "paper"),
        "registration": ("+ late registration, blended jumps", "paper"),
        "network": ("+ our network", "paper"),
        "estimate": ("+ one estimate of the tracker's errors", "paper"),
        "outline": ("+ outline of open hands", "paper"),
        "prediction": ("+ acceleration, resting joints: handcast", "paper"),
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
for part in ("first_seconds", "later"):
    BY_VARIANT[part] = {variant: BY_VARIANT["comparison"][variant] for variant in ("paper", "paper_network", "handcast")}
BY_VARIANT["jitter"] = {variant: BY_VARIANT["comparison"][variant] for variant in
                        ("baseline", "paper", "paper_network", "handcast", "handcast_mediapipe")}
# What has real detectors, on motions that nothing was tuned on: a table for each mesh.
BY_VARIANT["unseen"] = {variant: row for variant, row in BY_VARIANT["comparison"].items() if not variant.endswith("_model")}
# Tables by motion: the variants of the columns, and the one to whose error the last one's is compared.
BY_MOTION = {
    "motions": (["baseline", "paper", "handcast"], "paper"),
    "fast": (["baseline", "paper", "handcast"], "paper"),
    "no_tracker": (["baseline", "handcast", "no_tracker"], "handcast"),
}
PARTS = [*BY_VARIANT, *BY_MOTION]


def variants_of(part):
    """The variants of a table, in its order."""
    return BY_MOTION[part][0] if part in BY_MOTION else [*BY_VARIANT[part]]


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
                 runs.both(variant, None, "lit"), *(runs.percent(variant, name) for name in ("missing", "off_10mm")), *ratio]
        yield "| " + " | ".join(cells) + " |"


def table_by_motion(part, runs):
    """A row for each motion, a column for each variant."""
    variants, reference = BY_MOTION[part]
    last = variants[-1]
    runs.require(variants)
    yield ("| motion | " + " | ".join(f"{variant} ({runs.detector(variant)})" if variant != "baseline" else variant
                                      for variant in variants) +
           f" | ratio, {last} to {reference} | coverage / spill, %: " + " | ".join(variants) + " |")
    yield "|" + "---|" * (2 * len(variants) + 2)
    for motion in runs.motions:
        light = [f"{runs.percent(variant, 'coverage', motion)} / {runs.percent(variant, 'spill', motion)}" for variant in variants]
        cells = [motion, *(runs.both(variant, motion) for variant in variants),
                 interval(runs.ratios(last, reference, motion)), *light]
        yield "| " + " | ".join(cells) + " |"
    cells = ["all", *(runs.both(variant, None) for variant in variants), interval(runs.ratios_of_all(last, reference))]
    yield "| " + " | ".join(cells) + " |" + " |" * len(variants)


def table_of_jitter(runs):
    """A row for each variant, with the figure of each seed."""
    motion = runs.only_motion()
    yield "| | detector | the light, px RMS | each person |"
    yield "|---|---|---|---|"
    for variant in runs.variants:
        detector = "" if variant == "baseline" else runs.detector(variant)
        jitter = runs.of(variant, motion, "jitter_px")
        yield f"| {BY_VARIANT['jitter'][variant][0]} | {detector} | {interval(jitter)} | {', '.join(f'{px:.2f}' for px in jitter)} |"


def tables_by_mesh(part, runs):
    """A table for each mesh of true hands; what follows is about all of them."""
    for mesh in runs.meshes:
        yield f"True hands of the mesh `{mesh}`:"
        yield ""
        yield from table_by_variant(part, runs.of_mesh(mesh))
        yield ""
    yield "All meshes together:"


def table(part, runs):
    """The lines of a table."""
    if part in BY_MOTION:
        return table_by_motion(part, runs)
    if part == "jitter":
        return table_of_jitter(runs)
    return tables_by_mesh(part, runs) if part == "unseen" else table_by_variant(part, runs)


def footer(runs, command, people):
    """Whom the table is of, what has made it, and what is absent."""
    text = f"Seeds {listed(runs.seeds)}"
    text += f": {len(runs.seeds)} of the {people} people of the protocol." if len(runs.seeds) < people else "."
    if command:
        text += f" Made by `{command}`."
    if command.endswith("--quick"):
        text += " Quick: two motions of 1 s, after 0.5 s in which a rig learns."
    yield text
    if runs.left_out:
        yield f"Left out, because runs failed: the seeds {listed(runs.left_out)}."
    if runs.missing:
        yield f"{runs.missing} runs of the plan are absent: recordings or hands were not there, or the sweep was interrupted."
    for variant in runs.absent:
        yield f"`{variant}` was not measured: {runs.errors.get(variant) or 'it has no runs'}."
