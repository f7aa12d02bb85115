"""The live view of a run: the page's server with the pipeline behind it."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from fpcad.commands.console import ConsoleReporter, console
from fpcad.look.paths import PathStates, path_states
from fpcad.look.run import load
from fpcad.look.serve import LiveView, open_server
from fpcad.pipeline.by_hand import choose_by_hand, trace_candidate
from fpcad.pipeline.stage import Build
from fpcad.workers import available_cores


def explore_run(folder: Path, host: str, port: int, workers: int) -> None:
    """Serve the live view of a build folder until Ctrl-C."""
    with open_server(live_view(folder, workers), host, port) as server:
        address, opened = server.server_address[:2]
        console.print(f"http://{address}:{opened}/ shows {folder}; Ctrl-C ends", highlight=False)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            console.print("ended")


def live_view(folder: Path, workers: int = 0) -> LiveView:
    """A run with what the pipeline can do for its hands."""
    run = load(folder)
    build = Build(run.spec, folder, workers or available_cores(), ConsoleReporter())

    def trace(candidate: int) -> list[PathStates]:
        return [path_states(candidate, path) for path in trace_candidate(build, candidate)]

    return LiveView(run, trace, partial(choose_by_hand, build))
