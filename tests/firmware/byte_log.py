"""What a controller heard and when, so that a failure can be played again.

`python -m tests.firmware.byte_log FILE` plays a log against the core and tells where it ended.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fpcad.run.messages import Cause, State
from fpcad.store import write_whole
from tests.firmware.core import core_controller

FOLDER = Path(__file__).parents[2] / "build" / "byte_logs"


@dataclass
class Recorded:
    """A controller with the face of the one within, that notes its ticks and the bytes it takes."""

    device: Any
    heard: list[tuple[int, bytes]] = field(default_factory=list)
    ticks: int = 0

    def receive(self, data: bytes) -> None:
        if data:
            self.heard.append((self.ticks, data))
        self.device.receive(data)

    def tick(self) -> None:
        self.ticks += 1
        self.device.tick()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.device, name)

    def text(self) -> str:
        """Lines `tick hex`, the last one without bytes."""
        lines = [f"{tick} {data.hex()}" for tick, data in self.heard]
        return "\n".join([*lines, f"{self.ticks}", ""])


def replayed(text: str, device: Any) -> Any:
    """The controller after a log's bytes and ticks."""
    ticks = 0
    for line in text.splitlines():
        at, _, data = line.partition(" ")
        for _ in range(int(at) - ticks):
            device.tick()
        ticks = int(at)
        device.receive(bytes.fromhex(data))
        device.take_output()
    return device


@contextmanager
def kept_on_failure(recorded: Recorded, name: str) -> Iterator[None]:
    """Writes the log of a test that fails, and says where."""
    try:
        yield
    except AssertionError as error:
        file = FOLDER / f"{name}.log"
        file.parent.mkdir(parents=True, exist_ok=True)
        write_whole(file, recorded.text().encode())
        error.add_note(f"its bytes: python -m tests.firmware.byte_log {file}")
        raise


if __name__ == "__main__":
    end = replayed(Path(sys.argv[1]).read_text(), core_controller())
    print(
        f"{State(end.state).name} ({Cause(end.cause).name}) at {end.time_us / 1e6:.3f} s, path "
        f"{end.follower.path_us / 1e6:.3f} s, {end.follower.queued} knots queued, "
        f"{end.follower.bad_frames} bad frames, command {end.follower.command.round(6).tolist()}"
    )
