"""A browser, the page of a real run, and made-up runs."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from fpcad.look.report import report_page
from fpcad.look.run import Run, load
from fpcad.spec.schema import Spec
from tests.look.made_up import write_made_up_run

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = [
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
]
SCREENSHOTS = Path(__file__).parents[2] / "build" / "screenshots"
"""For people to look at; continuous integration keeps them."""
PATIENCE_MS = 120_000
"""A loaded machine draws slowly; nothing here tests how fast."""


@pytest.fixture(scope="session")
def made_up(clay: Spec, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A run of 60 made-up hands."""
    return load(write_made_up_run(tmp_path_factory.mktemp("made-up") / "clay", clay, 60))


@pytest.fixture(scope="session")
def real_run(built_clay: Path) -> Run:
    """A finished run of real hands, the chosen one exported."""
    return load(built_clay)


@pytest.fixture(scope="session")
def real_page(real_run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its page."""
    file = tmp_path_factory.mktemp("page") / "report.html"
    file.write_text(report_page(real_run), encoding="utf-8")
    return file


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Headless Chromium from the system's packages."""
    program = next(filter(None, map(shutil.which, BROWSERS)), None)
    if program is None:
        pytest.skip("needs a browser: on Debian, the package chromium")
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=program, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """An empty tab, as wide as a laptop's."""
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.set_default_timeout(PATIENCE_MS)
    yield tab
    tab.close()


def show(page: Page, file: Path) -> Page:
    """Open a page and wait until it answers."""
    page.goto(file.as_uri())
    page.wait_for_selector("html[data-ready]", state="attached")
    page.wait_for_function("() => !fpcad.figures.length || fpcad.figures.every((f) => f.width > 0)")
    return page
