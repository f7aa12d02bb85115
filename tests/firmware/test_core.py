"""The firmware's core against the Python definition: bytes, tables, quintics, limits."""

import ctypes
import ctypes.util
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings

from firmware_host.tools import generate
from fpcad.run.acceptance import first_violation
from fpcad.run.codec import CLASSES, KINDS, encode
from fpcad.run.firmware_setup import GAIN
from fpcad.run.framing import MAX_PAYLOAD, Frame, encode_frame
from fpcad.run.limits import from_counts
from fpcad.run.messages import State
from fpcad.run.quintic import Knots, evaluate_polynomial, segment_coefficients
from fpcad.run.sim.states import NEXT
from tests.firmware.core import library
from tests.firmware.segments import random_segments
from tests.run.fixtures import hand_limits
from tests.run.test_framing import FRAMES
from tests.run.test_messages import any_message


@pytest.mark.parametrize("name", generate.FILES)
def test_generated_files_are_up_to_date(name):
    written = (generate.CORE / name).read_text(encoding="utf-8")
    assert written == generate.FILES[name](), "run python -m firmware_host.tools.generate"


def recoded(kind: int, payload: bytes) -> bytes | None:
    out = ctypes.create_string_buffer(255)
    length = library().bench_recode(kind, payload, ctypes.c_uint8(len(payload)), out)
    return None if length == 255 else out.raw[:length]


@settings(deadline=None)
@given(any_message())
def test_messages_pass_through_c_unchanged(message):
    payload = encode(message)
    assert recoded(KINDS[type(message)].code, payload) == payload


@pytest.mark.parametrize("code", CLASSES)
def test_payloads_of_wrong_length_are_refused_in_c_as_in_python(code):
    good = {len(p) for p in (bytes(n) for n in range(MAX_PAYLOAD + 1)) if fits(code, p)}
    assert {n for n in range(MAX_PAYLOAD + 1) if recoded(code, bytes(n)) is not None} == good


def fits(code: int, payload: bytes) -> bool:
    kind = KINDS[CLASSES[code]]
    per_joint = sum({"i": 4, "h": 2, "b": 1}[c] for c in kind.joint_codes)
    rest = len(payload) - kind.scalars.size
    if not per_joint:
        return rest == 0
    return rest >= 0 and rest % per_joint == 0 and rest // per_joint <= 12


def framed(frame: Frame) -> bytes:
    wire = ctypes.create_string_buffer(255)
    length = library().bench_frame(
        ctypes.c_uint8(frame.kind),
        ctypes.c_uint16(frame.seq),
        ctypes.c_uint16(frame.session),
        frame.payload,
        ctypes.c_uint8(len(frame.payload)),
        wire,
    )
    return wire.raw[:length]


@settings(deadline=None)
@given(FRAMES)
def test_frames_of_c_and_of_python_are_the_same_bytes(frame):
    assert framed(frame) == encode_frame(Frame(frame.kind, frame.seq, frame.session, frame.payload))


def test_the_library_calls_its_own_functions():
    """Where a process holds zlib for all to see, its crc32 is another one."""
    code = (
        f"import ctypes; ctypes.CDLL({ctypes.util.find_library('z')!r}, ctypes.RTLD_GLOBAL)\n"
        "from tests.firmware.test_core import Frame, encode_frame, framed\n"
        "frame = Frame(1, 2, 3, b'four')\n"
        "assert framed(frame) == encode_frame(frame)\n"
    )
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_every_pair_of_the_state_table_is_the_same():
    for state, code in product(State, range(256)):
        following = NEXT.get((state, CLASSES.get(code, object)))
        assert library().bench_state_after(state, code) == (255 if following is None else following)


@pytest.mark.parametrize("seed", range(3))
def test_quintics_agree_within_a_count(seed):
    rows = random_segments(10_000, seed)
    results = np.zeros((len(rows), 3), np.int32)
    library().bench_quintic(rows.ctypes.data_as(ctypes.c_void_p), _pointer(results), len(rows))
    motion = reference(rows)
    assert np.abs(results[:, 0] - motion.position * 1e6).max() <= 1
    assert np.abs(results[:, 1] - motion.velocity * 1e6).max() <= 1
    assert np.abs(results[:, 2] - motion.acceleration * 1e6).max() <= 1


def reference(rows):
    """What Python says of segments (m, 9): both knots and the time since the first."""
    h = (rows[:, 4] - rows[:, 0]) / 1e6
    coefficients = np.array(
        [
            segment_coefficients(Knots(np.array([0.0, step]), *(row[k::4][:2, None] / 1e6 for k in (1, 2, 3))))[0]
            for row, step in zip(rows[:, :8], h, strict=True)
        ]
    )  # fmt: skip
    motion = evaluate_polynomial(coefficients, rows[:, 8] / 1e6 / h, h)
    return type(motion)(*(part[:, 0] for part in vars(motion).values()))


@pytest.mark.parametrize("seed", range(3))
def test_segments_are_judged_alike(seed):
    rows = plausible_segments(3_000, seed)
    limits = hand_limits().on_wire()
    box = [column[0] for column in vars(limits).values()]
    box = np.array([*box, -(2**31), *[2**31 - 1] * 3, GAIN, 0], np.int32)
    reasons = np.zeros(len(rows), np.uint8)
    library().bench_violation(_pointer(rows), _pointer(box), _pointer(reasons), len(rows))
    ours = np.array([judged(row) for row in rows])
    assert 0.2 < (ours == 0).mean() < 0.8 and len(set(ours)) == 4
    # They may differ only where the extremum is within a count of the limit, which chance avoids.
    np.testing.assert_array_equal(reasons, ours)


def plausible_segments(count, seed):
    """Rows (count, 8) near the limits: constant jerk, and a little else at the far end."""
    rng = np.random.default_rng(seed)
    h = rng.integers(4_000, 200_000, count)
    p = rng.uniform(-0.2e6, 1.8e6, count)
    v, a = rng.uniform(-1.6e6, 1.6e6, count), rng.uniform(-12e6, 12e6, count)
    jerk, s = rng.normal(size=count) * 3e7, h / 1e6
    way = v * s + a * s**2 / 2 + jerk * s**3 / 6 + rng.normal(size=count) * s**2 * 1e5
    columns = (0 * h, p, v, a, h, p + way, v + a * s + jerk * s**2 / 2, a + jerk * s)
    return np.stack(columns, axis=1).round().astype(np.int64)


def judged(row):
    one = hand_limits()
    limits = type(one)(("j",), *(getattr(one, f)[:1] for f in ("lower_rad", "upper_rad", "velocity_rad_s", "acceleration_rad_s2")))  # fmt: skip
    columns = (from_counts(row[k::4])[:, None] for k in (1, 2, 3))
    found = first_violation(Knots(row[::4] / 1e6, *columns), limits)
    return 0 if found is None else int(found.reason)


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)
