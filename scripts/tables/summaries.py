# SPDX-License-Identifier: Apache-2.0
"""The sentences of the README about the comparison and the unseen motions."""

from tables.runs import interval
from tables.verdicts import pairs_of


def larger_in(runs):
    """In how many cells the mean error of handcast is larger, for the pairs that have runs."""
    texts = []
    for ours, theirs, words in pairs_of(runs):
        count, of = runs.lost(ours, theirs)
        cells = str(count) if texts else f"{count} of {of} cells of {runs.cell_name()}"
        texts.append(f"in {cells} {words} (largest ratio {runs.largest_ratio(ours, theirs):.2f})")
    p95, _ = runs.lost("handcast", "paper", "interior_mm_p95")
    spill, of = runs.lost("handcast", "paper", "spill")
    return (f"The mean error of handcast is larger {', '.join(texts)}. As published, its p95 is larger in {p95} and the light beside the hand in "
            f"{spill} of {of}.")


def people_of(runs, people):
    """How many people there are, of how many."""
    text = f"{len(runs.seeds)} simulated people, each with other errors of the rig"
    return text + (f"; the protocol asks for {people}" if len(runs.seeds) < people else "")


def headline(runs, people):
    """The errors of both methods, their ratios, and where handcast is worse."""
    ours, theirs = runs.both("handcast", None), runs.both("paper", None)
    ratio = (f"{interval(runs.ratios_of_all('handcast', 'paper'))} ({'95 % ' if len(runs.seeds) > 2 else ''}over the "
             f"{people_of(runs, people)})")
    same = [f"{interval(runs.ratios_of_all(variant, paper))} {words} and our times for both" for variant, paper, words in
            (("handcast", "paper_network", "with our network"), ("handcast_mediapipe", "paper_mediapipe", "with MediaPipe"))
            if runs.has(variant) and runs.has(paper)]
    return (f"the light of handcast is {ours} mm (mean / p95) from its place with our network; that of the published method, as we wrote it anew, is "
            f"{theirs} mm off with {'MediaPipe' if 'mediapipe' in runs.detector('paper') else 'a model of a detector'} and its own times. The "
            f"ratio is {', '.join([ratio, *same[:-1]])}, and {same[-1]}. " + larger_in(runs))


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
    notes = {"implicit": ", on which nothing was tuned, and whose skin is nearer to the drawn one,"}
    parts = []
    for mesh in runs.meshes:
        alone = runs.of_mesh(mesh)
        parts.append(f"on `{mesh}`{notes.get(mesh, '')} {alone.both('handcast', None)} mm, a ratio of "
                     f"{interval(alone.ratios_of_all('handcast', 'paper'))}")
    yield "By mesh: " + "; ".join(parts) + "."


# By name: the sentences, and the table whose results they are about.
SUMMARIES = {"summary": (summary, "comparison"), "unseen_summary": (unseen_summary, "unseen")}
