# SPDX-License-Identifier: Apache-2.0
"""What the results say about the goals, and where handcast is worse than the paper's cascade."""

import statistics

from tables.runs import die, interval

# docs/method.md#goals. The first two are parts of the paper's error.
GOAL, GOAL_FAST, GOAL_MM = 0.45, 0.5, (1.8, 4.0)
GOAL_COVERAGE, GOAL_SPILL, GOAL_LATENCY_MS, GOAL_JITTER_PX, GOAL_TWO_HANDS = 0.99, 0.01, 6.6, 0.5, 1.1

# Pairs of variants that a table compares, and what makes them comparable.
PAIRS = [("handcast", "paper", "as published"), ("handcast", "paper_network", "with our network for both"),
         ("handcast_mediapipe", "paper_mediapipe", "with MediaPipe for both"),
         ("handcast_model", "paper_model", "with the model for both")]


def reached(is_reached):
    return "reached" if is_reached else "missed"


def listing(values):
    """1, 2 and 3."""
    texts = [str(value) for value in values]
    return " and ".join([", ".join(texts[:-1]), texts[-1]] if len(texts) > 1 else texts)


def pairs_of(runs):
    """The pairs that both have runs."""
    return [pair for pair in PAIRS if runs.has(pair[0]) and runs.has(pair[1])]


def lost_cells(runs, variant, reference):
    """In how many cells the mean error of `variant` is larger."""
    count, of = runs.lost(variant, reference)
    return f"{count} of {of} cells of {runs.cell_name()} (largest ratio {runs.largest_ratio(variant, reference):.2f})"


def verdict_of_comparison(runs):
    """What the comparison says about the goals, and where handcast is worse than the paper's cascade."""
    mean, p95 = (runs.mean("handcast", None, f"interior_mm_{of}") for of in ("mean", "p95"))
    ratios = runs.ratios_of_all("handcast", "paper")
    yield (f"handcast to the paper's cascade as published: {interval(ratios)}; the goal of {GOAL} is "
           f"{reached(statistics.fmean(ratios) <= GOAL)}. {mean:.1f} / {p95:.1f} mm; the goal of {GOAL_MM[0]} / {GOAL_MM[1]} mm is "
           f"{reached(mean <= GOAL_MM[0] and p95 <= GOAL_MM[1])}. "
           f"By the lit points alone, the ratio is {interval(runs.ratios_of_all('handcast', 'paper', 'lit_mm_mean'))}. "
           f"Dark or more than 10 mm off: {runs.percent('handcast', 'off_10mm')} % of the skin, {runs.percent('paper', 'off_10mm')} % with "
           "the paper's cascade.")
    pairs = pairs_of(runs)
    yield "The mean error of handcast is larger: " + "; ".join(
        f"{words}, in {lost_cells(runs, ours, theirs)}" for ours, theirs, words in pairs) + "."
    yield "In the same order, " + "; ".join(
        f"its {words} is larger in {listing([runs.lost(ours, theirs, name)[0] for ours, theirs, _ in pairs])} cells"
        for name, words in (("lit_mm_mean", "mean by the lit points alone"), ("interior_mm_p95", "p95"), ("missing", "dark share"),
                            ("off_10mm", "share that is dark or more than 10 mm off"), ("spill", "spill"))) + "."
    yield verdict_on_light(runs)


def verdict_on_light(runs):
    """What the light of handcast says about the goals of coverage, spill and fold-overs."""
    light = [cell for motion in runs.motions
             for cell in zip(*(runs.of("handcast", motion, name) for name in ("coverage", "spill", "foldovers")))]
    return (f"Coverage of handcast is below the goal of {100 * GOAL_COVERAGE:.0f} % in {sum(c < GOAL_COVERAGE for c, _, _ in light)} of "
            f"{len(light)} runs (least {100 * min(c for c, _, _ in light):.1f} %), its spill above the goal of {100 * GOAL_SPILL:.0f} % in "
            f"{sum(s > GOAL_SPILL for _, s, _ in light)} (most {100 * max(s for _, s, _ in light):.1f} %). Its drawing has fold-overs in "
            f"{sum(f > 0 for _, _, f in light)} of them (goal: none).")


def verdict_of_motions(runs):
    """Where handcast is worse than the paper's cascade, and what its light says."""
    yield f"The mean error of handcast is larger than that of the paper's cascade in {lost_cells(runs, 'handcast', 'paper')}."
    yield verdict_on_light(runs)


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
    yield (f"The goal is {GOAL_MM[0]} / {GOAL_MM[1]} mm. Perfect sensors alone ({mean:.1f} / {p95:.1f} mm) {better}. Coverage: "
           f"{', '.join(coverage)}; the goal is {100 * GOAL_COVERAGE:.0f} %.")


def verdict_of_two_hands(runs):
    """How much worse two hands are than the same hands alone."""
    motion = runs.only_motion()
    errors = list(zip(*(runs.of(variant, motion, "interior_mm_mean") for variant in ("left", "right", "both"))))
    if not all(left + right > 0 for left, right, _ in errors):
        die(f"{runs.path}: an error of hands alone is 0, so that nothing can be compared with it")
    ratios = [2 * both / (left + right) for left, right, both in errors]
    yield (f"Both hands to the mean of each alone: {interval(ratios)}; the goal of {GOAL_TWO_HANDS} is "
           f"{reached(statistics.fmean(ratios) <= GOAL_TWO_HANDS)}.")


def verdict_of_jitter(runs):
    jitter = runs.mean("handcast", runs.only_motion(), "jitter_px")
    yield f"The goal of {GOAL_JITTER_PX} px is {reached(jitter <= GOAL_JITTER_PX)} with our network."


# By table: what is said below it, and the variants that must have runs.
VERDICTS = {
    "comparison": (verdict_of_comparison, ["handcast", "paper", "paper_network"]),
    "unseen": (verdict_of_comparison, ["handcast", "paper", "paper_network"]),
    "causes": (verdict_of_causes, ["all_errors", "right_calibration", "perfect_sensors"]),
    "motions": (verdict_of_motions, ["handcast", "paper"]),
    "fast": (verdict_of_fast, ["handcast", "paper"]),
    "two_hands": (verdict_of_two_hands, ["left", "right", "both"]),
    "jitter": (verdict_of_jitter, ["handcast"]),
}


def verdict(part, runs):
    """The sentences below a table; none if there are no runs to judge by."""
    judge, needed = VERDICTS.get(part, (None, []))
    return list(judge(runs)) if judge and all(runs.has(variant) for variant in needed) else []
