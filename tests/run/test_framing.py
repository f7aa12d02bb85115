from itertools import combinations
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fpcad.run.framing import (
    MAX_PAYLOAD,
    BadFrame,
    Frame,
    FrameReader,
    cobs_decode,
    cobs_encode,
    decode_frame,
    encode_frame,
)

FRAMES = st.builds(
    Frame,
    kind=st.integers(0, 255),
    seq=st.integers(0, 0xFFFF),
    session=st.integers(0, 0xFFFF),
    payload=st.binary(max_size=MAX_PAYLOAD),
    version=st.integers(0, 255),
)
RAMP = bytes(range(1, 256))


@pytest.mark.parametrize(
    ("plain", "encoded"),
    [
        (b"", b"\x01"),
        (b"\0", b"\x01\x01"),
        (b"\0\0", b"\x01\x01\x01"),
        (b"\x11\x22\0\x33", b"\x03\x11\x22\x02\x33"),
        (b"\x11\x22\x33\x44", b"\x05\x11\x22\x33\x44"),
        (b"\x11\0\0\0", b"\x02\x11\x01\x01\x01"),
        (RAMP[:254], b"\xff" + RAMP[:254]),
        (b"\0" + RAMP[:254], b"\x01\xff" + RAMP[:254]),
        (RAMP, b"\xff" + RAMP[:254] + b"\x02\xff"),
        (RAMP[1:] + b"\0", b"\xff" + RAMP[1:] + b"\x01\x01"),
        (RAMP[2:] + b"\0\x01", b"\xfe" + RAMP[2:] + b"\x02\x01"),
    ],
)
def test_cobs_agrees_with_published_vectors(plain, encoded):
    assert cobs_encode(plain) == encoded
    assert cobs_decode(encoded) == plain


@given(st.binary(max_size=700))
def test_cobs_round_trips_without_zeros(data):
    encoded = cobs_encode(data)
    assert 0 not in encoded
    assert cobs_decode(encoded) == data


@given(FRAMES)
def test_frames_round_trip(frame):
    encoded = encode_frame(frame)
    assert encoded.count(0) == 1 and encoded[-1] == 0
    assert decode_frame(encoded[:-1]) == frame


def test_a_frame_has_these_bytes():
    frame = Frame(kind=0x12, seq=0x0102, session=0xA0B0, payload=b"\x40\x42\x0f\0")
    assert encode_frame(frame).hex() == "0a02120201b0a040420f05ca4f648400"


def test_payloads_have_a_largest_size():
    with pytest.raises(BadFrame, match="201 bytes"):
        encode_frame(Frame(1, 0, 0, bytes(201)))


def test_crc_notices_every_flip_of_one_or_two_bits():
    encoded = encode_frame(Frame(0x03, 7, 9, b"\x01\x02\x03"))
    bits = 8 * (len(encoded) - 1)
    for count in (1, 2):
        for positions in combinations(range(bits), count):
            assert FrameReader().feed(_flipped(encoded, positions)) == []


@pytest.mark.parametrize("seed", range(3))
def test_crc_notices_flips_of_three_bits_in_a_knot(seed):
    chance = Random(seed)
    encoded = encode_frame(Frame(0x11, 5, 77, chance.randbytes(152)))
    bits = 8 * (len(encoded) - 1)
    for _ in range(3000):
        assert FrameReader().feed(_flipped(encoded, chance.sample(range(bits), 3))) == []


@settings(max_examples=50)
@given(st.lists(FRAMES, max_size=5), st.integers(1, 40))
def test_the_reader_does_not_care_how_bytes_arrive(frames, size):
    stream = b"".join(encode_frame(frame) for frame in frames)
    reader = FrameReader()
    pieces = [stream[i : i + size] for i in range(0, len(stream), size)]
    assert [frame for piece in pieces for frame in reader.feed(piece)] == frames
    assert reader.bad_frames == 0


@settings(max_examples=50)
@given(st.binary(max_size=2000))
def test_the_reader_carries_on_behind_garbage(garbage):
    frame = Frame(1, 2, 3, b"after all")
    reader = FrameReader()
    reader.feed(garbage + b"\0")
    assert reader.feed(encode_frame(frame)) == [frame]


def test_an_endless_block_is_one_bad_frame():
    reader = FrameReader()
    for _ in range(1000):
        reader.feed(b"\x55" * 100)
    assert reader.feed(b"\0") == [] and reader.bad_frames == 1


def _flipped(encoded, positions):
    data = bytearray(encoded)
    for bit in positions:
        data[bit // 8] ^= 1 << bit % 8
    return bytes(data)
