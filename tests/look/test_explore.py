"""The live view: paths of every hand, another choice, and nobody else's requests."""

from __future__ import annotations

import http.client
import json
import shutil
from collections.abc import Iterator
from http.server import ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from playwright.sync_api import Page

from fpcad.commands.explore import live_view
from fpcad.errors import StoreError, ToolchainError
from fpcad.look.run import load
from fpcad.look.serve import LOOPBACK, TOKEN_HEADER, LiveView, open_server
from fpcad.pipeline.by_hand import REASON
from fpcad.pipeline.run import run_stages
from fpcad.pipeline.stage import Build
from fpcad.spec.load import load_spec
from fpcad.store import read_json
from tests.conftest import BUILT_HAND

EXPORTED = ("hand", "parts", "trajectories", "grip.json", "survival.json")
"""What the stage export writes in a build's folder."""
PATIENCE_S = 1800.0
"""Making a hand takes a busy machine long; nothing here tests how fast."""
Server = tuple[LiveView, ThreadingHTTPServer]


@pytest.fixture(scope="module")
def copied_build(built_clay: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A build that may be changed: the hand that its rule chose is not exported yet."""
    root = tmp_path_factory.mktemp("explore")
    (root / ".kernels").symlink_to(built_clay.parent / ".kernels", target_is_directory=True)
    without = shutil.ignore_patterns(*EXPORTED)
    folder = Path(shutil.copytree(built_clay, root / "clay", ignore=without))
    run_stages(Build(load_spec(folder / "spec.yaml"), folder, workers=1), "select", force=True)
    return folder


@pytest.fixture(scope="module")
def server(copied_build: Path) -> Iterator[Server]:
    view = live_view(copied_build, workers=1)
    with open_server(view, LOOPBACK, 0) as opened:
        Thread(target=opened.serve_forever, daemon=True).start()
        yield view, opened
        opened.shutdown()


def ask(server: Server, method: str, path: str, body: str = "", **headers: str) -> tuple[int, Any]:
    """Status and JSON of a request; underscores in header names stand for dashes."""
    host, port = server[1].server_address[:2]
    connection = http.client.HTTPConnection(str(host), port, timeout=PATIENCE_S)
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, named)
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    return answer.status, json.loads(text) if text.startswith("{") else text


def test_it_listens_to_this_machine_alone_by_default(server: Server):
    assert server[1].server_address[0] == "127.0.0.1"


def test_a_busy_port_is_told_in_a_line(server: Server):
    with pytest.raises(ToolchainError, match="take another one with --port"):
        open_server(server[0], LOOPBACK, server[1].server_address[1])


def test_a_name_that_leads_here_from_elsewhere_is_refused(server: Server):
    status, told = ask(server, "GET", "/", Host="evil.example")
    assert status == 403
    assert "address" in told["error"]


def test_only_the_page_may_choose(server: Server):
    body = json.dumps({"id": 1})
    assert ask(server, "POST", "/select", body)[0] == 403
    assert ask(server, "POST", "/select", body, X_Fpcad_Token="guessed")[0] == 403


@pytest.mark.parametrize("path", ["/paths", "/paths?id=x", "/paths?id=1&id=y", "/etc/passwd"])
def test_what_makes_no_sense_is_refused(server: Server, path):
    status, _ = ask(server, "GET", path)
    assert status in (200, 400, 404)
    assert status != 200 or "id=1" in path


def test_a_hand_that_is_not_there_is_told(server: Server):
    status, told = ask(server, "GET", "/paths?id=999")
    assert status == 409
    assert "no candidate 999" in told["error"]


def test_paths_of_every_hand_are_there_kept_or_not(server: Server):
    for candidate in server[0].run.ids:
        status, told = ask(server, "GET", f"/paths?id={candidate}")
        assert status == 200
        assert [path["pose"] for path in told["exact"]] == server[0].run.poses


def test_the_live_page_shows_a_path_that_its_server_sends(server: Server, page: Page):
    host, port = server[1].server_address[:2]
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.goto(f"http://{host!s}:{port}/")
    page.wait_for_selector("html[data-ready]", state="attached")
    page.evaluate("fpcad.state.select(fpcad.state.count - 1)")
    page.wait_for_function("() => fpcad.player.motion.kind === 'path'")
    for k in range(5):
        page.evaluate("(row) => fpcad.state.select(row)", k)
        page.locator("button", has_text="Keep beside").click()
    assert page.locator("#compare .card").count() == 4
    assert said == []


def test_pictures_and_models_can_be_saved(server: Server, page: Page):
    host, port = server[1].server_address[:2]
    page.goto(f"http://{host!s}:{port}/")
    page.wait_for_selector("html[data-ready]", state="attached")
    for button, start in (("Save PNG", b"\x89PNG"), ("Save GLB", b"glTF")):
        with page.expect_download() as download:
            page.locator("button", has_text=button).click()
        assert Path(download.value.path()).read_bytes().startswith(start)


def exported(folder: Path) -> dict[str, bytes]:
    """All that the stage export wrote, by path."""
    files = [file for name in EXPORTED for file in [folder / name, *folder.glob(f"{name}/**/*")]]
    return {str(f.relative_to(folder)): f.read_bytes() for f in files if f.is_file()}


def test_another_hand_is_chosen_exported_and_stays_chosen(
    server: Server, copied_build: Path, built_clay: Path
):
    """It is the other build's hand: the same input gives the same bytes."""
    view, _ = server
    assert view.run.selected is not None and view.run.selected["id"] != BUILT_HAND
    body = json.dumps({"id": BUILT_HAND})
    status, told = ask(server, "POST", "/select", body, **{TOKEN_HEADER: view.token})
    assert status == 200
    assert told == {"chosen": BUILT_HAND}
    chosen = read_json(copied_build / "selected.json")
    assert (chosen["id"], chosen["reason"]) == (BUILT_HAND, REASON)
    assert load(copied_build).manifest["stages"]["report"]["status"] == "done"
    page = (copied_build / "report.html").read_text(encoding="utf-8")
    assert f"hand {BUILT_HAND}" in page
    made, before = exported(copied_build), exported(built_clay)
    assert len(made) > 100 and made.keys() == before.keys()
    assert [name for name in made if made[name] != before[name]] == []


def test_a_run_of_another_version_is_not_chosen_from(copied_build: Path, tmp_path: Path):
    folder = Path(shutil.copytree(copied_build, tmp_path / "clay"))
    manifest = (folder / "manifest.json").read_text(encoding="utf-8")
    key = json.loads(manifest)["stages"]["select"]["key"]
    (folder / "manifest.json").write_text(manifest.replace(key, "0" * 64), encoding="utf-8")
    with pytest.raises(StoreError, match="fpcad design clay"):
        live_view(folder, workers=1).choose(0)
