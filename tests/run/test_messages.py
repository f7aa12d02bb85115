import pytest
from hypothesis import given
from hypothesis import strategies as st

from fpcad.run import messages
from fpcad.run.codec import CLASSES, KINDS, MalformedMessage, decode, encode
from fpcad.run.framing import MAX_PAYLOAD
from fpcad.run.messages import MAX_JOINTS, Estop, Hello, Knot, Ping, Start, Telemetry, Welcome

RANGES = {
    "B": st.integers(0, 2**8 - 1),
    "H": st.integers(0, 2**16 - 1),
    "I": st.integers(0, 2**32 - 1),
    "Q": st.integers(0, 2**64 - 1),
    "16s": st.binary(min_size=16, max_size=16),
}
SIGNED = {"i": 32, "h": 16, "b": 8}
ALL = sorted(KINDS, key=lambda cls: KINDS[cls].code)


def signed(code, joints):
    edge = 2 ** (SIGNED[code] - 1)
    return st.tuples(*[st.integers(-edge, edge - 1)] * joints)


@st.composite
def any_message(draw):
    cls = draw(st.sampled_from(ALL))
    joints = draw(st.integers(1, MAX_JOINTS))
    return cls(
        **{
            field.name: draw(
                signed(field.metadata["code"], joints)
                if field.metadata["per_joint"]
                else RANGES[field.metadata["code"]]
            )
            for field in cls.__dataclass_fields__.values()
        }
    )


@given(any_message())
def test_messages_round_trip(message):
    payload = encode(message)
    assert len(payload) <= MAX_PAYLOAD
    assert decode(KINDS[type(message)].code, payload) == message


def test_type_bytes_are_unique_and_stable():
    codes = {cls.__name__: KINDS[cls].code for cls in ALL}
    assert codes == {
        "Hello": 0x01, "AskLimits": 0x02, "Ping": 0x03, "Hold": 0x04, "Estop": 0x05,
        "AskHoming": 0x06,
        "Arm": 0x10, "Knot": 0x11, "Start": 0x12, "End": 0x13, "Clear": 0x14,
        "Home": 0x15, "Calibrate": 0x16,
        "Welcome": 0x40, "Limits": 0x41, "Pong": 0x42, "Ack": 0x43, "Nak": 0x44,
        "Refused": 0x45, "NoSession": 0x46, "Telemetry": 0x47, "Health": 0x48,
        "HomingReport": 0x49,
    }  # fmt: skip
    assert len(CLASSES) == len(KINDS)


@pytest.mark.parametrize(
    ("message", "payload"),
    [
        (Hello(), ""),
        (Estop(), ""),
        (Ping(1), "0100000000000000"),
        (Start(1_000_000), "40420f0000000000"),
        (Knot(40_000, (1, -1), (2, -2), (3, -3), (4, -4)),
         "409c00000000000001000000ffffffff02000000feffffff03000000fdffffff0400fcff"),
        (Welcome(2, 12, 3, 0, 250, 32, 7, 0x0102030405060708, 1, 9, b"fpcad-sim".ljust(16, b"\0")),
         "020c0300fa0020000700000008070605040302010109000000" + b"fpcad-sim".hex() + "00" * 7),
        (Telemetry(4000, 0, 5, 0, 1000, 31, 2, (9,), (10,)),
         "a00f00000000000000000000000000000500e8031f000200090000000a000000"),
    ],
)  # fmt: skip
def test_payloads_have_these_bytes(message, payload):
    assert encode(message).hex() == payload


@pytest.mark.parametrize(
    ("code", "payload", "complaint"),
    [
        (0x99, b"", "unknown message type 0x99"),
        (0x03, b"1234567", "Ping cannot have 7 bytes"),
        (0x01, b"x", "Hello cannot have 1 bytes"),
        (0x11, bytes(8 + 13), "Knot cannot have 21 bytes"),
    ],
)
def test_payloads_that_do_not_fit_are_refused(code, payload, complaint):
    with pytest.raises(MalformedMessage, match=complaint):
        decode(code, payload)


@pytest.mark.parametrize(
    "message", [Knot(0, (2**31,), (0,), (0,), (0,)), Knot(0, (0, 0), (0,), (0,), (0,)), Ping(-1)]
)
def test_values_that_do_not_fit_are_refused(message):
    with pytest.raises(MalformedMessage):
        encode(message)


def test_every_command_of_the_host_is_below_the_controllers_answers():
    hosts = {cls for cls in ALL if KINDS[cls].code < 0x40}
    assert {messages.Hello, messages.Knot, messages.Estop} <= hosts
    assert messages.Telemetry not in hosts
    assert all(KINDS[cls].sequenced is False for cls in ALL if cls not in hosts)
