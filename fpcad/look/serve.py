"""The live view: the page over all candidates, served to this machine, with paths on demand."""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Lock
from typing import Any, cast
from urllib.parse import parse_qs, urlsplit

from fpcad.errors import FpcadError, ToolchainError
from fpcad.look.kept import tell_paths
from fpcad.look.pack import Packer
from fpcad.look.paths import PathStates, stored_paths
from fpcad.look.report import report_page
from fpcad.look.run import Run, load

LOOPBACK = "127.0.0.1"
TOKEN_HEADER = "X-Fpcad-Token"
MAX_BODY = 1000


@dataclass
class LiveView:
    """A run with what only its server can do; one request at a time."""

    run: Run
    trace: Callable[[int], Sequence[PathStates]]
    """Traces the paths of a candidate that the store keeps none of."""
    choose: Callable[[int], int]
    """Makes a candidate the chosen hand, exports it, and returns the id of the one that is."""
    token: str = field(default_factory=lambda: secrets.token_urlsafe(16))
    _lock: Lock = field(default_factory=Lock)
    _page: str = ""

    def page(self) -> str:
        """The page of the run as it is now."""
        with self._lock:
            self._page = self._page or report_page(self.run, self.token)
            return self._page

    def paths(self, candidate: int) -> dict[str, Any]:
        """All paths of a candidate, from the store or traced now, and their block of numbers."""
        with self._lock:
            stored = list(stored_paths(self.run.folder / "paths.parquet", {candidate}))
            pack = Packer("traced")
            told = tell_paths(self.run, pack, stored or self.trace(candidate))
            return {"exact": told, "block": pack.text()}

    def select(self, candidate: int) -> dict[str, Any]:
        """Choose a candidate by hand; tells which one is chosen now."""
        with self._lock:
            chosen = self.choose(candidate)
            self.run, self._page = load(self.run.folder), ""
            return {"chosen": chosen}


def open_server(view: LiveView, host: str, port: int) -> ThreadingHTTPServer:
    """A server that is bound and not yet running; :class:`ToolchainError` where the port is busy."""
    handler = type("Handler", (_Handler,), {"view": view})
    try:
        return ThreadingHTTPServer((host, port), handler)
    except OSError as error:
        raise ToolchainError(
            f"{host}:{port} cannot be used ({error.strerror}); take another one with --port, or "
            "--port 0 for any that is free"
        ) from error


class _Handler(BaseHTTPRequestHandler):
    view: LiveView

    def do_GET(self) -> None:
        """The page, or the paths of one candidate."""
        asked = urlsplit(self.path)
        if not self._is_ours():
            self._refuse(HTTPStatus.FORBIDDEN, "open the page by the address that was printed")
        elif asked.path == "/":
            self._answer(HTTPStatus.OK, "text/html; charset=utf-8", self.view.page())
        elif asked.path == "/paths":
            self._tell(lambda: self.view.paths(int(parse_qs(asked.query)["id"][0])))
        else:
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here")

    def do_POST(self) -> None:
        """Choose a candidate; only the page itself knows the token."""
        sent = self.headers.get(TOKEN_HEADER, "")
        if not self._is_ours() or not secrets.compare_digest(sent, self.view.token):
            self._refuse(HTTPStatus.FORBIDDEN, "reload the page")
        elif self.path != "/select":
            self._refuse(HTTPStatus.NOT_FOUND, "there is nothing here")
        else:
            length = min(int(self.headers.get("Content-Length", "0")), MAX_BODY)
            body = self.rfile.read(length)
            self._tell(lambda: self.view.select(int(json.loads(body)["id"])))

    def _is_ours(self) -> bool:
        """Whether the browser asked for this address, not for a name that leads here."""
        host, port = cast("tuple[str, int]", self.server.server_address)
        names = {f"{name}:{port}" for name in (host, LOOPBACK, "localhost")}
        return self.headers.get("Host", "") in names

    def _tell(self, work: Callable[[], dict[str, Any]]) -> None:
        try:
            told = work()
        except FpcadError as error:
            self._refuse(HTTPStatus.CONFLICT, str(error))
        except (KeyError, ValueError):
            self._refuse(HTTPStatus.BAD_REQUEST, "a number of a hand is missing")
        else:
            self._answer(HTTPStatus.OK, "application/json", json.dumps(told, allow_nan=False))

    def _refuse(self, status: HTTPStatus, why: str) -> None:
        self._answer(status, "application/json", json.dumps({"error": why}))

    def _answer(self, status: HTTPStatus, kind: str, text: str) -> None:
        body = text.encode("utf-8")
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: the page says what went wrong."""
