"""Everything on the page without a mouse."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from tests.look.conftest import show

FOCUSED = """() => {
  const at = document.activeElement;
  return at.id || at.closest("[id]")?.id + ": " + (at.ariaLabel || at.textContent || at.type || at.tagName);
}"""


@pytest.fixture(scope="module")
def opened(real_page: Path, browser: Browser) -> Iterator[Page]:
    """One page for all of these tests: each says where it starts."""
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    yield show(tab, real_page)
    tab.close()


def stops(page: Page, count: int) -> list[str]:
    """What Tab comes to, from the top of the page."""
    page.evaluate("document.activeElement.blur()")
    page.evaluate("getSelection().collapse(document.body, 0)")
    found = []
    for _ in range(count):
        page.keyboard.press("Tab")
        found.append(page.evaluate(FOCUSED))
    return found


def test_tab_goes_down_the_page_and_everything_is_reached(opened: Page):
    found = " | ".join(stops(opened, 40))
    places = [found.find(word) for word in ("pick", "to-chosen", "Play", "Tool along", "Reset")]
    assert -1 not in places
    assert places == sorted(places)
    for word in ("Keep beside", "pareto-across", "Landscape of", "Parallel", "Filters"):
        assert word in found


def test_what_has_the_focus_is_outlined(opened: Page):
    opened.locator("#player .play").focus()
    opened.keyboard.press("Tab")
    style = opened.evaluate("getComputedStyle(document.activeElement).outlineStyle")
    assert style == "solid"


@pytest.mark.parametrize("key", ["Enter", "Space"])
def test_play_and_pause(opened: Page, key):
    play = opened.locator("#player .play")
    play.focus()
    opened.keyboard.press(key)
    assert play.inner_text() == "Pause"
    opened.keyboard.press(key)
    assert play.inner_text() == "Play"


def test_arrows_on_the_slider_move_the_fingers_by_one_state(opened: Page):
    opened.evaluate("fpcad.player.show(3)")
    opened.locator("input[type=range]").focus()
    before = opened.evaluate("fpcad.stage.hand.readJoints()")
    opened.keyboard.press("ArrowRight")
    assert opened.evaluate("fpcad.player.frame") == 4
    assert opened.evaluate("fpcad.stage.hand.readJoints()") != before
    opened.keyboard.press("Home")
    assert opened.evaluate("fpcad.player.frame") == 0


def test_arrows_choose_the_pose(opened: Page):
    opened.locator("#player input[type=radio]").first.focus()
    opened.keyboard.press("ArrowRight")
    assert opened.evaluate("fpcad.player.pose") == 1
    opened.keyboard.press("ArrowLeft")
    assert opened.evaluate("fpcad.player.pose") == 0


@pytest.mark.parametrize("key", ["ArrowLeft", "ArrowUp", "+", "-"])
def test_the_view_turns_and_zooms(opened: Page, key):
    opened.locator("#stage canvas").focus()
    before = opened.evaluate("fpcad.stage.camera.position.toArray()")
    opened.keyboard.press(key)
    assert opened.evaluate("fpcad.stage.camera.position.toArray()") != before


def test_reset_brings_the_view_back(opened: Page):
    opened.locator("button", has_text="Reset view").press("Enter")
    before = opened.evaluate("fpcad.stage.camera.position.toArray()")
    opened.locator("#stage canvas").press("ArrowLeft")
    opened.locator("button", has_text="Reset view").press("Enter")
    assert opened.evaluate("fpcad.stage.camera.position.toArray()") == pytest.approx(before)


def test_arrows_in_a_figure_go_to_a_neighbouring_hand(opened: Page):
    before = opened.evaluate("fpcad.state.selected")
    opened.locator("#landscapes .plot").first.focus()
    for key in ("ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"):
        opened.keyboard.press(key)
        if opened.evaluate("fpcad.state.selected") != before:
            return
    pytest.fail("no arrow key goes to another hand")


def test_a_typed_number_selects(opened: Page):
    opened.locator("#pick").fill("2")
    opened.keyboard.press("Enter")
    assert opened.locator("#selected-title").inner_text() == "Hand 2"


def test_a_line_of_the_list_selects(opened: Page):
    line = opened.locator("#list button").last
    line.press("Enter")
    assert opened.locator("#selected-title").inner_text() == f"Hand {line.inner_text()}"


def test_a_hand_is_kept_beside_and_removed(opened: Page):
    opened.locator("button", has_text="Keep beside").press("Enter")
    assert opened.locator("#compare .card").count() == 1
    opened.locator("#compare button", has_text="Remove").press("Enter")
    assert opened.locator("#compare .card").count() == 0
