"""Gates of stand and jigs: what would refuse a part of the hand is a warning here, and leaves a jig out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from fpcad.make.gates.all_gates import check_part
from fpcad.make.gates.finding import Finding, Severity, errors
from fpcad.make.mesh import INTERFERENCE_MM3
from fpcad.make.parts.part import Part
from fpcad.make.stand.clear import TOLD_MM, BoltedHand, least_gap, shared_volume
from fpcad.spec.schema import Spec

Array = NDArray[np.float64]

GATE = "jig"
LEAST_GAP_MM = 0.5
"""What a jig must keep from the parts themselves, which lie within the capsules that it was placed by."""


def check_jig(
    spec: Spec, jig: Part, away: Array, postures: Sequence[Array], hand: BoltedHand
) -> list[Finding]:
    """A jig's findings, its distance to the hand's parts among them.

    Args:
        jig: in the stand's frame, as are all parts here.
        away: (3,) unit vector along which it is drawn away.
        postures: joints (n_fingers, 3) [rad] at the pose first, then of the grip as it opens.
    """
    checks = check_part(spec, jig)
    faults = errors(checks)
    if faults:
        return [_warned(jig.name, faults[0], "left out: ")]
    gap = least_gap(jig.mesh, away, postures, hand)
    severity = Severity.FIGURE if gap >= LEAST_GAP_MM else Severity.WARNING
    more = " or more" if gap >= TOLD_MM else ""
    text = f"{gap:.2f} mm{more} to the hand from open to closed grip, and while it is drawn away"
    return [*checks, Finding(GATE, severity, jig.name, gap, LEAST_GAP_MM, "mm", text)]


def check_bench(
    spec: Spec, part: Part, postures: Sequence[Array], hand: BoltedHand
) -> list[Finding]:
    """Findings of a part of the stand, which shares no room with the hand at any of the postures."""
    checks = check_part(spec, part)
    faults = errors(checks)
    found = [_warned(part.name, faults[0])] if faults else checks
    volume = shared_volume(part.mesh, postures, hand)
    if volume > INTERFERENCE_MM3:
        text = f"it shares {volume:.3g} mm^3 with the hand"
        found.append(Finding(GATE, Severity.WARNING, part.name, volume, 0.0, "mm^3", text))
    return found


def left_out(findings: Iterable[Finding]) -> bool:
    """Whether a jig with these findings is no use."""
    return any(f.severity is Severity.WARNING and f.gate == GATE for f in findings)


def _warned(name: str, fault: Finding, before: str = "") -> Finding:
    text = before + fault.text
    return Finding(GATE, Severity.WARNING, name, fault.value, fault.limit, fault.unit, text)
