"""Writes the C side's view of the messages and of the state table from their one definition.

Run as `python -m firmware_host.tools.generate` in the repository's root; a test holds that the
committed files are what this writes.
"""

from __future__ import annotations

import re
from dataclasses import fields
from enum import IntEnum
from pathlib import Path

from fpcad.run import framing, messages
from fpcad.run.codec import KINDS
from fpcad.run.messages import Cause, HomingOutcome, Reason, State
from fpcad.run.sim.states import NEXT

CORE = Path(__file__).parents[1] / "core"
_TYPES = {"B": "uint8_t", "b": "int8_t", "H": "uint16_t", "h": "int16_t", "I": "uint32_t"}
_TYPES |= {"i": "int32_t", "Q": "uint64_t"}
_BYTES = {"B": 1, "b": 1, "H": 2, "h": 2, "I": 4, "i": 4, "Q": 8}
_NOTE = (
    "/* Written by firmware_host/tools/generate.py from fpcad/run/messages.py; do not edit. */\n"
)


def snake(name: str) -> str:
    """`AskLimits` as `ask_limits`."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", name).lower()


def _size(code: str) -> int:
    return int(code[:-1]) if code.endswith("s") else _BYTES[code]


def _enumeration(cls: type[IntEnum]) -> str:
    prefix = snake(cls.__name__).upper()
    body = "".join(f"    {prefix}_{member.name} = {member.value},\n" for member in cls)
    return f"enum {snake(cls.__name__)} {{\n{body}}};\n"


def _declaration(field) -> str:
    code, per_joint = field.metadata["code"], field.metadata["per_joint"]
    if code.endswith("s"):
        return f"    uint8_t {field.name}[{code[:-1]}];\n"
    return f"    {_TYPES[code]} {field.name}{'[MAX_JOINTS]' if per_joint else ''};\n"


def _layout(cls: type) -> tuple[list, list, int, int]:
    scalars = [f for f in fields(cls) if not f.metadata["per_joint"]]
    joints = [f for f in fields(cls) if f.metadata["per_joint"]]
    fixed = sum(_size(f.metadata["code"]) for f in scalars)
    return scalars, joints, fixed, sum(_size(f.metadata["code"]) for f in joints)


def _put(field, index: str = "") -> str:
    code = field.metadata["code"]
    if code.endswith("s"):
        return f"at = put_bytes(at, in->{field.name}, {code[:-1]});"
    bits = 8 * _BYTES[code]
    return f"at = put_u{bits}(at, (uint{bits}_t)in->{field.name}{index});"


def _get(field, index: str = "") -> str:
    code = field.metadata["code"]
    if code.endswith("s"):
        return f"at = get_bytes(at, out->{field.name}, {code[:-1]});"
    bits = 8 * _BYTES[code]
    return f"out->{field.name}{index} = ({_TYPES[code]})get_u{bits}(at); at += {bits // 8};"


def _signatures(cls: type) -> tuple[str, str]:
    name = snake(cls.__name__)
    encode = f"uint8_t encode_{name}(const struct {name} *in, uint8_t joints, uint8_t *payload)"
    decode = (
        f"bool decode_{name}(const uint8_t *payload, uint8_t length, uint8_t *joints, "
        f"struct {name} *out)"
    )
    return encode, decode


def _functions(cls: type) -> str:
    scalars, joints, fixed, each = _layout(cls)
    encode, decode = _signatures(cls)
    loops_put = "".join(
        f"    for (uint8_t i = 0; i < joints; i++) {{\n        {_put(f, '[i]')}\n    }}\n"
        for f in joints
    )
    loops_get = "".join(
        f"    for (uint8_t i = 0; i < *joints; i++) {{\n        {_get(f, '[i]')}\n    }}\n"
        for f in joints
    )
    if joints:
        bad = f"rest < 0 || rest % {each} || rest / {each} > MAX_JOINTS"
        count = f"(uint8_t)(rest / {each})"
    else:
        bad, count = "rest", "0"
    return (
        f"{encode}\n{{\n    uint8_t *at = payload;\n"
        + "".join(f"    {_put(f)}\n" for f in scalars)
        + (loops_put or "    (void)joints;\n")
        + ("" if scalars else "    (void)in;\n")
        + "    return (uint8_t)(at - payload);\n}\n\n"
        + f"{decode}\n{{\n    const uint8_t *at = payload;\n"
        + f"    int16_t rest = (int16_t)(length - {fixed});\n    if ({bad}) {{\n        return false;\n    }}\n"
        + f"    *joints = {count};\n"
        + "".join(f"    {_get(f)}\n" for f in scalars)
        + loops_get
        + ("" if scalars or joints else "    (void)out;\n")
        + "    (void)at;\n    return true;\n}\n"
    )


def _struct(cls: type) -> str:
    # C has no empty structs.
    body = "".join(_declaration(f) for f in fields(cls)) or "    uint8_t nothing;\n"
    return f"struct {snake(cls.__name__)} {{\n{body}}};\n"


def _by_code() -> list[type]:
    return sorted(KINDS, key=lambda cls: KINDS[cls].code)


def messages_header() -> str:
    """Text of core/messages.h."""
    codes = "".join(
        f"    MESSAGE_{snake(cls.__name__).upper()} = 0x{KINDS[cls].code:02x},\n"
        for cls in _by_code()
    )
    parts = [
        _NOTE
        + "#ifndef MESSAGES_H\n#define MESSAGES_H\n\n#include <stdbool.h>\n#include <stdint.h>\n",
        f"#define PROTOCOL_VERSION {framing.PROTOCOL_VERSION}\n#define MAX_PAYLOAD {framing.MAX_PAYLOAD}\n"
        f"#define MAX_JOINTS {messages.MAX_JOINTS}\n#define PRELOAD_URAD {messages.PRELOAD_URAD}\n",
        f"enum message {{\n{codes}}};\n",
        *(_enumeration(cls) for cls in (State, Cause, HomingOutcome, Reason)),
        *(_struct(cls) for cls in _by_code()),
        "".join(f"{line};\n" for cls in _by_code() for line in _signatures(cls)),
        "#endif\n",
    ]
    return "\n".join(parts)


def messages_source() -> str:
    """Text of core/messages.c."""
    head = _NOTE + '#include "messages.h"\n\n#include "bytes.h"\n\n'
    return head + "\n".join(_functions(cls) for cls in _by_code())


def states_header() -> str:
    """Text of core/state_table.h: the next state of each (state, command), or REFUSED."""
    commands = sorted({cls for _, cls in NEXT}, key=lambda cls: KINDS[cls].code)
    names = "".join(f"    COMMAND_{snake(cls.__name__).upper()},\n" for cls in commands)
    rows = []
    for state in State:
        cells = (NEXT.get((state, cls)) for cls in commands)
        row = ", ".join("REFUSED" if n is None else f"STATE_{n.name}" for n in cells)
        rows.append(f"    [STATE_{state.name}] = {{{row}}},\n")
    note = _NOTE.replace("messages.py", "sim/states.py")
    return (
        f'{note}#ifndef STATE_TABLE_H\n#define STATE_TABLE_H\n\n#include "messages.h"\n\n'
        f"#define REFUSED 0xff\n\nenum command {{\n{names}    COMMAND_COUNT,\n}};\n\n"
        f"static const uint8_t STATE_TABLE[{len(State)}][COMMAND_COUNT] = {{\n{''.join(rows)}}};\n\n#endif\n"
    )


FILES = {
    "messages.h": messages_header,
    "messages.c": messages_source,
    "state_table.h": states_header,
}


def main() -> None:
    """Write the generated files of the core."""
    for name, text in FILES.items():
        (CORE / name).write_text(text(), encoding="utf-8")


if __name__ == "__main__":
    main()
