"""Frames on the wire: COBS with a zero delimiter around a header, a payload and a CRC-32."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass

PROTOCOL_VERSION = 2
MAX_PAYLOAD = 200
DELIMITER = b"\0"

_HEADER = struct.Struct("<BBHH")
_CRC = struct.Struct("<I")
_MAX_BLOCK = _HEADER.size + MAX_PAYLOAD + _CRC.size + 1
"""Longest COBS block of a legal frame [bytes]: up to 253 bytes cost one byte more."""


class BadFrame(ValueError):
    """Bytes between two delimiters that are no frame."""


@dataclass(frozen=True, slots=True)
class Frame:
    """One frame; `kind` is the message's type byte, `session` chosen by the host's HELLO."""

    kind: int
    seq: int
    session: int
    payload: bytes = b""
    version: int = PROTOCOL_VERSION


def cobs_encode(data: bytes) -> bytes:
    """Data without zero bytes (Cheshire and Baker, 1999); the delimiter is not added."""
    out = bytearray()
    runs = data.split(b"\0")
    for index, run in enumerate(runs):
        full_blocks = 0
        while len(run) >= 254:
            out += b"\xff" + run[:254]
            run = run[254:]
            full_blocks += 1
        if run or not full_blocks or index < len(runs) - 1:
            out.append(len(run) + 1)
            out += run
    return bytes(out)


def cobs_decode(block: bytes) -> bytes:
    """Inverse of :func:`cobs_encode`; raises :class:`BadFrame` on bytes that it cannot make."""
    out = bytearray()
    at = 0
    while at < len(block):
        code = block[at]
        run = block[at + 1 : at + code]
        if code == 0 or len(run) != code - 1 or 0 in run:
            raise BadFrame(f"COBS code {code} at byte {at} of {len(block)}")
        out += run
        at += code
        if code < 255 and at < len(block):
            out.append(0)
    return bytes(out)


def encode_frame(frame: Frame) -> bytes:
    """Bytes to write, delimiter included."""
    if len(frame.payload) > MAX_PAYLOAD:
        raise BadFrame(f"payload of {len(frame.payload)} bytes; at most {MAX_PAYLOAD} are allowed")
    body = _HEADER.pack(frame.version, frame.kind, frame.seq, frame.session) + frame.payload
    return cobs_encode(body + _CRC.pack(zlib.crc32(body))) + DELIMITER


def decode_frame(block: bytes) -> Frame:
    """Frame from the bytes between two delimiters; raises :class:`BadFrame`."""
    data = cobs_decode(block)
    if len(data) < _HEADER.size + _CRC.size:
        raise BadFrame(f"{len(data)} bytes are too few")
    body, (crc,) = data[: -_CRC.size], _CRC.unpack(data[-_CRC.size :])
    if zlib.crc32(body) != crc:
        raise BadFrame("CRC-32 does not match")
    version, kind, seq, session = _HEADER.unpack_from(body)
    payload = body[_HEADER.size :]
    if len(payload) > MAX_PAYLOAD:
        raise BadFrame(f"payload of {len(payload)} bytes")
    return Frame(kind, seq, session, payload, version)


class FrameReader:
    """Cuts a stream of bytes into frames; counts what is none and carries on behind it."""

    def __init__(self) -> None:
        self.bad_frames = 0
        self.bytes_read = 0
        self._block = bytearray()
        self._overlong = False

    def feed(self, data: bytes) -> list[Frame]:
        """Frames completed by `data`, in order."""
        self.bytes_read += len(data)
        *ended, rest = data.split(DELIMITER)
        frames = []
        for piece in ended:
            self._append(piece)
            frames += self._finish()
        self._append(rest)
        return frames

    def _append(self, piece: bytes) -> None:
        self._overlong = self._overlong or len(self._block) + len(piece) > _MAX_BLOCK
        if not self._overlong:
            self._block += piece

    def _finish(self) -> list[Frame]:
        block, overlong = bytes(self._block), self._overlong
        self._block.clear()
        self._overlong = False
        if not block and not overlong:
            return []
        try:
            if overlong:
                raise BadFrame("longer than any frame")
            return [decode_frame(block)]
        except BadFrame:
            self.bad_frames += 1
            return []
