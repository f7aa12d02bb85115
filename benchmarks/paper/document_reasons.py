"""Why our numbers differ from the paper's: sentences that hold only what the tables show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from benchmarks.paper.markdown import share, table
from benchmarks.paper.packing import Filling
from benchmarks.paper.results import Outcome, Results
from fpcad.sample.rrt import ACCEPTED, TOO_CLOSE

GEOMETRY = "geometry"
SOLVE, STATICS = ": solve", ": statics"


def reasons_section(results: Results) -> str:
    """The differences one by one."""
    return "\n\n".join(
        [
            "## Why ours differ",
            _plane_count(results),
            table(
                (
                    "step",
                    "candidates at the 1 % stop",
                    "calls until then",
                    "candidates after all calls",
                ),
                [_filling_row(filling) for filling in results.fillings],
            ),
            _plane_verdict(results),
            _full_efficiency(results.full),
            _occupied(results.full),
            *(_wielding(outcome) for outcome in (results.plane, results.full)),
        ]
    )


def _plane_count(results: Results) -> str:
    plane, settings = results.plane, results.plane.tally.spec.sampling
    missed = calls_that_fail(plane)
    box = (
        "sampling met no edge of the feasible space inside the box, and nothing but the distance rule "
        "rejects hands"
        if missed == 0
        else "the rest of the missing candidates is due to the distance rule"
    )
    calls = results.plane_calls.tally.calls
    return (
        f"**2D, number of candidates.** Of our {plane.tally.calls:,} calls {missed:,} failed at a pose or its "
        f"statics: {box}. To see what that rule gives by itself, the sampler was run with every attempt "
        f"succeeding (distance {settings.min_distance:.5f}, {calls:,} calls):"
    )


def _filling_row(filling: Filling) -> tuple[str, ...]:
    counts = (filling.window_candidates, filling.window_calls, filling.total_candidates)
    return (f"{filling.step:g}", *(f"{count:,}" for count in counts))


def _plane_verdict(results: Results) -> str:
    paper, plane, calls = results.plane.published, results.plane.tally, results.plane_calls.tally
    most = max(filling.total_candidates for filling in results.fillings)
    known = (
        f"The paper's {paper.candidates} are more than any of these steps gives in as many calls, in a box where "
        "nothing fails. Its sampling must place hands more tightly than this rule does; the text does "
        "not say how."
        if most < paper.candidates
        else f"The paper's {paper.candidates} lie within what the step alone can make of this rule."
    )
    return (
        f"The paper's run ended at {paper.candidates} / {paper.calls:,} = {paper.efficiency:.2%} of *all* calls; ours "
        f"ends when the last {plane.spec.sampling.efficiency_window:,} calls bring less than "
        f"{plane.spec.sampling.min_efficiency:.0%}, after {plane.calls:,} calls with {plane.candidates:,}. Let run for "
        f"{calls.calls:,} calls, it finds {calls.candidates:,}. {known}"
    )


def _full_efficiency(outcome: Outcome) -> str:
    t, paper = outcome.tally, outcome.published
    parts = {
        "poses that were not solved": _ending(outcome, SOLVE),
        "statics": _ending(outcome, STATICS),
        "overlapping roots": t.outcomes[GEOMETRY],
        "the distance rule": t.outcomes[TOO_CLOSE],
    }
    told = ", ".join(f"{share(n, t.calls, 1)} to {name}" for name, n in parts.items())
    pose, lost = max(_by_pose(outcome).items(), key=lambda item: item[1])
    return (
        f"**6D, efficiency.** {t.efficiency:.1%} against {paper.efficiency:.1%}. We lose {told}. The "
        f"pose that fails most is `{pose}` ({share(lost, t.calls, 1)}). The paper does not tell its reasons, so "
        "the difference cannot be split between its ranges, its solver (an active-set method from the "
        "parent's pose) and its statics. Its distance rule cannot explain it, if it steps as we do: "
        f"that costs us {t.outcomes[TOO_CLOSE] / t.calls:.1%}."
    )


def _occupied(outcome: Outcome) -> str:
    t, paper = outcome.tally, outcome.published
    return (
        f"**6D, occupied volume.** It follows from number and distance alone: {t.candidates:,} balls of radius "
        f"{t.spec.sampling.min_distance / 2:.5f} fill {100 * t.occupied:.3g} %, the paper's {paper.candidates:,} fill "
        f"{100 * paper.occupied:.3g} %. The nearest two of ours are {t.least_distance:.5f} apart."
    )


def _wielding(outcome: Outcome) -> str:
    t, paper = outcome.tally, outcome.published
    failing = t.candidates - t.beyond("all", 0)
    head = (
        f"**{outcome.title}, TMR > 0.** {share(t.beyond('all', 0), t.candidates)} in all poses against "
        f"{paper.wielding['all']:.2%}."
    )
    return head if failing == 0 else f"{head} {' '.join(_failure_sentences(outcome))}"


def _failure_sentences(outcome: Outcome) -> Iterator[str]:
    for pose, ends in outcome.tally.failures.items():
        total = sum(ends.values())
        if total:
            (minus, plus), most = ends.most_common(1)[0]
            known = sum(n for pair, n in ends.items() if set(pair) <= {"statics", "limits"})
            yield (
                f"`{pose}` fails {total:,} times, {most:,} of them with ends `{minus}` and `{plus}`; both ends are "
                f"statics or limits, the paper's two reasons, in {known:,}."
            )


def calls_that_fail(outcome: Outcome) -> int:
    """Calls that ended neither in a candidate nor by the distance rule."""
    good = (ACCEPTED, TOO_CLOSE)
    return sum(count for kind, count in outcome.tally.outcomes.items() if kind not in good)


def _ending(outcome: Outcome, suffix: str) -> int:
    return sum(n for kind, n in outcome.tally.outcomes.items() if kind.endswith(suffix))


def _by_pose(outcome: Outcome) -> dict[str, int]:
    t = outcome.tally
    suffixes: Sequence[str] = (SOLVE, STATICS)
    return {pose: sum(t.outcomes[pose + s] for s in suffixes) for pose in t.spec.poses}
