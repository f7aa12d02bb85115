"""The page about trials in physics, from results made up so that its numbers are known."""

from __future__ import annotations

from benchmarks.physics_hypothesis.report import OF_GRIP, page
from benchmarks.physics_hypothesis.scores import KINEMATIC
from benchmarks.physics_hypothesis.summary import with_physics


def result(
    number: int,
    share: float,
    held: bool = True,
    faults: dict[str, str] | None = None,
    tipped: bool = False,
):
    trial = {"held": held, "wielded": held and not tipped, "reached_share": share}
    metrics = {name: float(number) for name in KINEMATIC}
    margins = dict.fromkeys(OF_GRIP, 1.0)
    pose = {"metrics": metrics, "margins": margins, "trials": {"unloaded": trial}}
    return {"id": number, "poses": {"a": pose}, "faults": faults or {}, "seconds": 1.0}


def test_hands_are_counted_by_load_and_share():
    hands = [result(1, 0.4), result(2, 0.6, tipped=True), result(3, 0.95)]
    text = page([*hands, result(4, 0.99, held=False)], "x")
    row = next(line for line in text.splitlines() if line.startswith("| unloaded | a |"))
    counts = [cell.split(")")[0].split("(")[1] for cell in row.split("|")[3:7]]
    assert counts == ["3", "2", "2", "1"]


def test_a_pose_without_trajectory_counts_as_not_held():
    text = page([result(1, 0.95, faults={"b": "no grip"}), result(2, 0.95)], "x")
    row = next(line for line in text.splitlines() if line.startswith("| unloaded | all |"))
    assert "50% (1)" in row


def test_a_figure_that_orders_hands_as_physics_does_correlates_fully():
    text = page([result(n, 0.2 * n) for n in range(1, 5)], "x")
    row = next(line for line in text.splitlines() if line.startswith("| metrics tmr_deg"))
    assert row.endswith("| +1.00 |")
    assert "| margins cone_share | - |" in text


def test_the_summary_goes_to_the_results():
    results = [result(n, 0.2 * n) for n in range(1, 6)]
    document = with_physics("# Results\n\n## In physics\n\nolder\n", page(results, "x"))
    assert document.startswith("# Results\n\n## In physics\n\nWhether hands")
    assert "- unloaded: 5 hold, 5 never tip, 3 pass half, 1 nine tenths\n" in document
    assert document.endswith("- unloaded: a `tmr_deg` +1.00\n")
