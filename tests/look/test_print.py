"""The page on paper: dark on white, no controls, nothing cut."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from tests.look.conftest import SCREENSHOTS, show

A4_WIDTH = 688
"""Of what lies between the margins [CSS pixels]."""
INKED = """() => [...document.querySelectorAll(".plot")].map((plot) => {
  const seen = [...plot.querySelectorAll("canvas")].filter((c) => c.checkVisibility());
  const inked = seen.map((c) => c.getContext("2d").getImageData(0, 0, c.width, c.height).data.some((v) => v));
  return [seen.length, inked.every(Boolean)];
})"""


@pytest.fixture(scope="module")
def printed(browser: Browser, real_page: Path) -> Iterator[Page]:
    """The page as a printer gets it, opened in a dark room."""
    tab = browser.new_page(viewport={"width": 1280, "height": 900}, color_scheme="dark")
    show(tab, real_page)
    tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    tab.emulate_media(media="print")
    tab.set_viewport_size({"width": A4_WIDTH, "height": 900})
    yield tab
    tab.close()


def test_paper_is_white_and_ink_dark(printed: Page):
    style = "getComputedStyle(document.body).{}"
    assert printed.evaluate(style.format("backgroundColor")) == "rgb(255, 255, 255)"
    assert printed.evaluate(style.format("color")) == "rgb(26, 29, 32)"


@pytest.mark.parametrize(
    "control", [".picker", ".transport", "#actions", "#pareto-axes", "#list-controls", ".filters"]
)
def test_what_only_a_screen_can_do_is_gone(printed: Page, control):
    assert not printed.locator(control).is_visible()


def test_nothing_is_wider_than_the_paper(printed: Page):
    assert printed.evaluate("document.documentElement.scrollWidth") <= A4_WIDTH
    ends = printed.evaluate(
        "[...document.querySelectorAll('.plot, .plot > svg, .plot canvas, table, #stage canvas')]"
        ".filter((e) => e.checkVisibility()).map((e) => e.getBoundingClientRect().right)"
    )
    assert max(ends) <= A4_WIDTH + 1


def test_every_figure_is_on_one_canvas_that_is_not_empty(printed: Page):
    figures = printed.evaluate(INKED)
    assert len(figures) >= 9 + 5
    assert {count for count, _ in figures} <= {0, 1}
    assert all(inked for _, inked in figures)


def test_the_printed_page_is_kept_for_people_to_look_at(browser: Browser, real_page: Path):
    tab = show(browser.new_page(color_scheme="dark"), real_page)
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    tab.pdf(path=SCREENSHOTS / "report.pdf", format="A4")
    assert tab.evaluate("'print' in document.documentElement.dataset") is False
    tab.close()
