"""How a message becomes a payload: one registry that dataclasses enter with a decorator.

A payload is its scalar fields in order, then its fields with one value a joint, all little-endian
and unpadded. The number of joints follows from the payload's length.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import lru_cache
from typing import Any, TypeVar, dataclass_transform


class MalformedMessage(ValueError):
    """A payload that does not fit its type."""


@dataclass(frozen=True)
class Kind:
    """How one message class travels."""

    code: int
    sequenced: bool
    """Acknowledged, resent and acted on in order; other messages are acted on at receipt."""
    scalars: struct.Struct
    scalar_names: tuple[str, ...]
    joint_codes: str
    joint_names: tuple[str, ...]


KINDS: dict[type, Kind] = {}
CLASSES: dict[int, type] = {}
T = TypeVar("T")


def wire(code: str, *, per_joint: bool = False) -> Any:
    """A dataclass field with its struct code (`B`, `H`, `I`, `Q`, `i`, `16s`)."""
    return field(metadata={"code": code, "per_joint": per_joint})


@dataclass_transform(frozen_default=True, field_specifiers=(wire,))
def message(code: int, *, sequenced: bool = False) -> Callable[[type[T]], type[T]]:
    """Registers a dataclass as the message with type byte `code`."""

    def register(cls: type[T]) -> type[T]:
        frozen: Any = dataclass(frozen=True)(cls)
        scalars = [f for f in fields(frozen) if not f.metadata["per_joint"]]
        joints = [f for f in fields(frozen) if f.metadata["per_joint"]]
        KINDS[frozen] = Kind(
            code,
            sequenced,
            struct.Struct("<" + "".join(f.metadata["code"] for f in scalars)),
            tuple(f.name for f in scalars),
            "".join(f.metadata["code"] for f in joints),
            tuple(f.name for f in joints),
        )
        CLASSES[code] = frozen
        return frozen

    return register


def encode(msg: Any) -> bytes:
    """Payload of a message; raises :class:`MalformedMessage` on a value that does not fit."""
    kind = KINDS[type(msg)]
    arrays = [getattr(msg, name) for name in kind.joint_names]
    joints = len(arrays[0]) if arrays else 0
    if any(len(values) != joints for values in arrays):
        raise MalformedMessage(f"{type(msg).__name__}: fields of unequal joint count")
    try:
        payload = kind.scalars.pack(*(getattr(msg, name) for name in kind.scalar_names))
        flat = [value for values in arrays for value in values]
        return payload + _joint_struct(kind.joint_codes, joints).pack(*flat)
    except struct.error as error:
        raise MalformedMessage(f"{type(msg).__name__}: {error}") from error


def decode(code: int, payload: bytes) -> Any:
    """Message of type byte `code`; raises :class:`MalformedMessage`."""
    cls = CLASSES.get(code)
    if cls is None:
        raise MalformedMessage(f"unknown message type 0x{code:02x}")
    kind = KINDS[cls]
    per_joint = struct.calcsize("<" + kind.joint_codes)
    rest = len(payload) - kind.scalars.size
    if rest < 0 or (rest % per_joint if per_joint else rest):
        raise MalformedMessage(f"{cls.__name__} cannot have {len(payload)} bytes")
    joints = rest // per_joint if per_joint else 0
    scalars = kind.scalars.unpack_from(payload)
    flat = _joint_struct(kind.joint_codes, joints).unpack_from(payload, kind.scalars.size)
    arrays = [flat[i * joints : (i + 1) * joints] for i in range(len(kind.joint_names))]
    return cls(*scalars, *arrays)


@lru_cache(maxsize=64)
def _joint_struct(codes: str, joints: int) -> struct.Struct:
    return struct.Struct("<" + "".join(code * joints for code in codes))
