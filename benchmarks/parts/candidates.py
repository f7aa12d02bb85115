"""One design after the other: made with all gates green, or refused with a reason."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from fpcad.errors import FpcadError, MakeError
from fpcad.make.gates.all_gates import gate_groups
from fpcad.make.gates.early import check_early
from fpcad.make.gates.finding import Severity, refuse_errors
from fpcad.make.parts.assembly import make_assembly
from fpcad.model.geometry import hand_geometry
from fpcad.model.hand import hand_template
from fpcad.pipeline.apart import Tell, run_apart
from fpcad.sample.space import design_space
from fpcad.spec.schema import Spec

NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")
SKIPPED = ("reach",)
"""Groups of gates that are left out: reach warns and refuses nothing."""


@dataclass(frozen=True)
class Outcome:
    """What became of one design."""

    named: tuple[float, ...]
    """d1 to d6 [mm, deg]."""
    verdict: str
    """`made`, `refused early` (by numbers alone), `refused` (by a part or a gate) or `crashed`."""
    reason: str
    warnings: int
    seconds: float
    """Processor time."""


def designs(spec: Spec, count: int, seed: int, corners: bool) -> Iterator[NDArray[np.float64]]:
    """The box's corners if wanted, then random designs, so many in all; impossible ones are left out."""
    space, template = design_space(spec.hand), hand_template(spec.hand)
    n, left = int(space.free.sum()), count

    def standardized() -> Iterator[NDArray[np.float64]]:
        if corners:
            yield from (np.array(signs) / 2 for signs in product((-1.0, 1.0), repeat=n))
        rng = np.random.default_rng(seed)
        while True:
            yield rng.uniform(-0.5, 0.5, n)

    for values in standardized():
        named = space.named(values)
        if left == 0:
            return
        if template.feasible(space.internal(named)):
            left -= 1
            yield named


def attempt(spec: Spec, named: NDArray[np.float64], skipped: tuple[str, ...] = SKIPPED) -> Outcome:
    """Make one hand and run the gates that need no trajectory, but those whose title begins as told."""
    space, template = design_space(spec.hand), hand_template(spec.hand)
    started, warnings, verdict, reason = time.process_time(), 0, "refused early", ""
    try:
        geometry = hand_geometry(template, space.internal(named))
        check_early(spec, geometry)
        verdict = "refused"
        assembly = make_assembly(spec, geometry, lambda _: None)
        for title, check in gate_groups(spec, assembly, geometry, {}):
            if not title.startswith(skipped):
                found = check()
                refuse_errors(found)
                warnings += sum(f.severity is Severity.WARNING for f in found)
        verdict = "made"
    except FpcadError as error:
        reason = str(error)
    except Exception as error:  # noqa: BLE001 - a crash is what this looks for
        verdict, reason = "crashed", f"{type(error).__name__}: {error}"
    seconds = time.process_time() - started
    return Outcome(tuple(named.tolist()), verdict, reason, warnings, seconds)


def attempt_apart(spec: Spec, named: NDArray[np.float64], cpu_s: int = 900) -> Outcome:
    """As `attempt`, in a process that is ended after so much processor time: then the hand is `crashed`."""
    try:
        return run_apart(_attempt, (spec, named), cpu_s, lambda _: None)
    except MakeError as error:
        return Outcome(tuple(named.tolist()), "crashed", str(error), 0, float(cpu_s))


def _attempt(_: Tell, asked: tuple[Spec, NDArray[np.float64]]) -> Outcome:
    return attempt(*asked)


def kind_of(reason: str) -> str:
    """A reason without its numbers, so that like ones can be counted."""
    return NUMBER.sub("#", reason.split(" (and ")[0].split(" at (")[0])
