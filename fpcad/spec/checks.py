"""Checks across the parts of a spec: names that must exist, values that must fit each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from fpcad.spec.catalogue import flange_sizes, metal_sizes, motor_types
from fpcad.spec.checks_initial import check_initial
from fpcad.spec.checks_pose import check_poses
from fpcad.spec.faults import KeyPath, one_of, quoted
from fpcad.spec.hand import Hand, PalmCapsule, ParameterRange
from fpcad.spec.hardware import RIGID, Motors
from fpcad.spec.mount import Mount
from fpcad.spec.names import check_exact_keys, span
from fpcad.spec.parts import INTERVAL, PALM_PRIMITIVE, Finding, Parts
from fpcad.spec.process import Sampling
from fpcad.spec.templates import TEMPLATES, TemplateNames
from fpcad.spec.wiring import Wiring

DISTAL_LENGTH = "d1_distal_length_mm"
WIDEST_JOINT_DEG = (-170.0, 170.0)
"""Joints turn by less than half a turn; the skin's cut at the IP joint needs it."""


def cross_check(parts: Parts) -> Iterator[Finding]:
    """All findings that no single value shows."""
    template = parts.get(("hand", "template"), str)
    names = TEMPLATES.get(template) if template is not None else None
    if template is not None and names is None:
        yield Finding(("hand", "template"), one_of(TEMPLATES, template))
    if names is not None:
        yield from _check_parameters(parts, names)
        yield from _check_joints(parts, names)
        yield from _check_palm(parts, names)
        yield from check_poses(parts, names)
        yield from check_initial(parts, names)
        yield from _check_wiring(parts, names)
    yield from _check_palm_names(parts)
    yield from _check_sampling(parts)
    yield from _check_motors(parts)
    yield from _check_mount(parts)
    yield from _check_cross(parts)


def _check_parameters(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    root = ("hand", "parameters")
    yield from check_exact_keys(parts, root, names.parameters, "a range {min: .., max: ..}")
    for path, name, value in parts.entries(root, ParameterRange):
        low, high = value.bounds
        key = "value" if value.value is not None else "min"
        if name in names.parameters and name.endswith("_mm") and low <= 0:
            yield Finding((*path, key), "a length greater than 0")
        length = parts.get_or(
            ("hand", "finger_length_mm"), float, Hand.model_fields["finger_length_mm"].default
        )
        if name == DISTAL_LENGTH and length is not None and high >= length:
            key = "value" if value.value is not None else "max"
            yield Finding((*path, key), f"a length less than hand.finger_length_mm = {length:g}")


def _check_joints(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    root = ("hand", "joint_limits_deg")
    yield from check_exact_keys(parts, root, names.joints, "a range [low, high] of two numbers")
    limits = {name: value for _, name, value in parts.entries(root, INTERVAL)}
    for name, (low, high) in limits.items():
        if low < WIDEST_JOINT_DEG[0] or high > WIDEST_JOINT_DEG[1]:
            yield Finding((*root, name), f"a range inside {span(WIDEST_JOINT_DEG)}")
    rest = ("hand", "rest_posture_deg")
    for path, name, angle in parts.entries(rest, float):
        if name not in names.joints:
            yield _unknown(path, "joint", name, names.joints)
        elif name in limits and not limits[name][0] <= angle <= limits[name][1]:
            yield Finding(path, f"an angle inside the joint's limits {span(limits[name])}")


def _check_palm(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    for path, solid in parts.items(("hand", "palm"), PALM_PRIMITIVE):
        if solid is None:
            continue
        keys = ("start", "end") if isinstance(solid, PalmCapsule) else ("at",)
        for key in keys:
            site = getattr(solid, key)
            if site not in names.sites:
                yield Finding((*path, key), one_of(names.sites, site))


def _check_palm_names(parts: Parts) -> Iterator[Finding]:
    first: dict[str, int] = {}
    for path, solid in parts.items(("hand", "palm"), PALM_PRIMITIVE):
        if solid is None:
            continue
        index = int(path[-1])
        if solid.name in first:
            other = f"hand.palm[{first[solid.name]}]"
            yield Finding((*path, "name"), f"a name of its own ({other} has this one)")
        first.setdefault(solid.name, index)


def _check_sampling(parts: Parts) -> Iterator[Finding]:
    sampling = parts.get_or(("sampling",), Sampling, Sampling())
    if sampling is None or sampling.step > sampling.min_distance:
        return
    given = parts.keys(("sampling",)) or ()
    if "step" in given:
        allowed = f"a number greater than sampling.min_distance = {sampling.min_distance:g}"
        yield Finding(("sampling", "step"), allowed)
    else:
        allowed = f"a number less than sampling.step = {sampling.step:g}"
        yield Finding(("sampling", "min_distance"), allowed)


def _check_motors(parts: Parts) -> Iterator[Finding]:
    motor = parts.get_or(("motors", "type"), str, Motors.model_fields["type"].default)
    if motor is not None and motor not in motor_types():
        yield Finding(("motors", "type"), one_of(motor_types(), motor))


def _check_mount(parts: Parts) -> Iterator[Finding]:
    flange = parts.get_or(("mount", "flange"), str, Mount.model_fields["flange"].default)
    if flange is not None and flange not in flange_sizes():
        yield Finding(("mount", "flange"), one_of(flange_sizes(), flange))


def _check_cross(parts: Parts) -> Iterator[Finding]:
    known = (RIGID, *metal_sizes())
    named = parts.get_or(("print", "cross_material"), str, RIGID)
    if named is not None and named not in known:
        yield Finding(("print", "cross_material"), one_of(known, named))


def _check_wiring(parts: Parts, names: TemplateNames) -> Iterator[Finding]:
    root = ("motors", "wiring")
    wiring = parts.get_or(root, Wiring, Wiring())
    if wiring is None:
        return
    known = True
    for table in ("ids", "signs", "gear_ratios"):
        for finger in parts.keys((*root, table)) or ():
            if finger not in names.fingers:
                known = False
                yield _unknown((*root, table, finger), "finger", finger, names.fingers)
    numbers = wiring.numbers(names.fingers) if known else ()
    twice = sorted({number for number in numbers if numbers.count(number) > 1})
    if twice:
        yield Finding((*root, "ids"), "an id of its own for each motor", f"id {twice[0]} twice")


def _unknown(path: KeyPath, what: str, name: str, known: Sequence[str]) -> Finding:
    return Finding(path, one_of(known, name), f"unknown {what} {quoted(name)}", "key")
