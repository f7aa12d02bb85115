"""The page in a browser: one selection in all figures, and a hand that moves as its path says."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, FloatRect, Page

from fpcad.look.report import report_page, write_report
from fpcad.look.run import Run
from fpcad.model.geometry import link_poses
from fpcad.model.hand import hand_template
from tests.look.conftest import SCREENSHOTS, show
from tests.look.test_logs import log_table, write_log

SLICE = 4000
"""Height of one picture [CSS pixels]; longer ones repeat themselves."""

PLACE = """(row) => {
  const plot = fpcad.figures.find((f) => f.box.closest("#pareto"));
  const box = plot.box.getBoundingClientRect(), [x, y] = plot.place(row);
  return [box.left + x, box.top + y];
}"""
DRAWN = """() => {
  const marks = fpcad.figures.filter((f) => f.marks instanceof HTMLCanvasElement);
  const curves = [...document.querySelectorAll(".lines svg")].map((svg) => svg.outerHTML);
  return {
    figures: [...marks.map((f) => f.marks.toDataURL()), ...curves],
    hand: fpcad.stage.canvas.toDataURL(),
    numbers: document.getElementById("numbers").textContent,
  };
}"""
LONELY = """() => {
  const plot = fpcad.figures.find((f) => f.box.closest("#pareto"));
  const places = Array.from({ length: fpcad.state.count }, (_, row) => plot.place(row));
  const gap = (row) => Math.min(...places.map(([x, y], other) => other === row ? Infinity
    : Math.hypot(x - places[row][0], y - places[row][1])));
  const others = places.map((_, row) => row).filter((row) => row !== fpcad.state.selected);
  return others.reduce((best, row) => (gap(row) > gap(best) ? row : best));
}"""


@pytest.fixture
def opened(page: Page, real_page: Path) -> Page:
    return show(page, real_page)


def test_the_page_says_nothing_on_the_console_and_asks_nobody(page: Page, real_page: Path):
    said: list[str] = []
    asked: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    show(page, real_page)
    page.locator("#player .play").click()
    page.locator("label.chip", has_text="printed parts").click()
    page.wait_for_timeout(300)
    assert said == []
    assert asked == [real_page.as_uri()]


def test_the_chosen_hand_is_shown_first(opened: Page, real_run: Run):
    assert real_run.selected is not None
    assert opened.locator("#pick").input_value() == str(real_run.selected["id"])
    assert opened.locator("#selected-title").inner_text() == f"Hand {real_run.selected['id']}"


def test_a_click_in_one_figure_marks_the_hand_in_all_and_changes_the_3d_view(opened: Page):
    row = opened.evaluate(LONELY)
    opened.locator("#pareto").scroll_into_view_if_needed()
    before: dict[str, Any] = opened.evaluate(DRAWN)
    opened.mouse.click(*opened.evaluate(PLACE, row))
    after: dict[str, Any] = opened.evaluate(DRAWN)
    assert opened.evaluate("fpcad.state.selected") == row
    unmarked = [old == new for old, new in zip(before["figures"], after["figures"], strict=True)]
    assert not any(unmarked)
    assert len(unmarked) >= 9 + 4
    assert after["hand"] != before["hand"]
    assert after["numbers"] != before["numbers"]


WHERE = """([name, share]) => {
  const boxes = [...document.querySelectorAll(name)], figure = fpcad.figures.find((f) => boxes.includes(f.box));
  figure.box.scrollIntoView({ block: "center" });
  const box = figure.box.getBoundingClientRect(), { x, y, width, height } = box;
  if (!figure.place) return [x + share * width, y + 0.5 * height];
  const others = Array.from({ length: fpcad.state.count }, (_, row) => row).filter((row) => row !== fpcad.state.selected);
  const [px, py] = figure.place(others[0]);
  return [x + px, y + py];
}"""


@pytest.mark.parametrize(
    "figure",
    ["#landscapes .plot", "#map .plot", "#parallel .plot", "#shares .plot", "#efficiency .plot"],
)
def test_a_click_in_any_figure_selects_a_hand_for_all(opened: Page, figure):
    chosen = opened.evaluate("fpcad.state.selected")
    before: dict[str, Any] = opened.evaluate(DRAWN)
    for share in (0.12, 0.5, 0.97):  # one of the three is another hand
        if opened.evaluate("fpcad.state.selected") == chosen:
            opened.mouse.click(*opened.evaluate(WHERE, [figure, share]))
    after: dict[str, Any] = opened.evaluate(DRAWN)
    assert opened.evaluate("fpcad.state.selected") != chosen
    assert after["hand"] != before["hand"]
    assert after["numbers"] != before["numbers"]
    redrawn = [old != new for old, new in zip(before["figures"], after["figures"], strict=True)]
    assert all(redrawn)


def test_a_brush_filters_by_what_it_covers(opened: Page, real_run: Run):
    opened.locator("#parallel").scroll_into_view_if_needed()
    axis = "fpcad.figures.find((f) => f.columns).columns[6]"
    x, top, name = opened.evaluate(
        f"() => {{ const c = {axis}, box = document.querySelector('#parallel .plot').getBoundingClientRect();"
        " return [box.left + c.x, box.top + c.y(100), c.name]; }"
    )
    low = opened.evaluate(f"{axis}.y(50) - {axis}.y(100)")
    opened.mouse.move(x, top)
    opened.mouse.down()
    opened.mouse.move(x, top + low, steps=5)
    opened.mouse.up()
    limit = opened.evaluate("(name) => fpcad.state.limits.get(name).range", name)
    assert limit == pytest.approx([50, 100], abs=2)
    scores = real_run.matrix([name])[:, 0]
    passing = [int(limit[0] <= score <= limit[1]) for score in scores]
    assert opened.evaluate("Array.from(fpcad.state.passing)") == passing


@pytest.mark.parametrize("index", [0, 1, 2])
def test_the_slider_moves_the_fingers_along_the_stored_path(opened: Page, real_run: Run, index):
    assert real_run.selected is not None
    pose = real_run.poses[index]
    path = real_run.paths(real_run.selected["id"]).to_pylist()
    states = sorted((s for s in path if s["pose"] == pose), key=lambda s: s["state"])
    opened.locator("label.chip", has_text=pose).click()
    slider = opened.locator("input[type=range]")
    assert slider.get_attribute("max") == str(len(states) - 1)
    for k in np.linspace(0, len(states) - 1, 7).astype(int):
        slider.fill(str(k))
        joints = opened.evaluate("fpcad.stage.hand.readJoints()")
        assert joints == pytest.approx(states[k]["joints_rad"], abs=1e-6)
        shown = opened.evaluate("fpcad.player.motion.at(fpcad.player.frame).turn")
        assert shown == pytest.approx(states[k]["tool_angle_rad"], abs=1e-6)


def test_links_lie_where_the_model_has_them(opened: Page, real_run: Run):
    for row, candidate in enumerate(real_run.candidates.sort_by("id").to_pylist()[:4]):
        opened.evaluate("(row) => fpcad.state.select(row)", row)
        joints = np.array(opened.evaluate("fpcad.stage.hand.readJoints()")).reshape(4, 3)
        design = real_run.space.internal(np.array([candidate[n] for n in real_run.space.names]))
        poses = link_poses(hand_template(real_run.spec.hand), design, joints)
        for finger, links in poses.items():
            for link, T in links.items():
                matrix = opened.evaluate(
                    "(link) => (fpcad.stage.scene.updateMatrixWorld(), "
                    "fpcad.stage.hand.links[link].matrixWorld.toArray())",
                    f"{finger}_{link}",
                )
                shown = np.array(matrix).reshape(4, 4).T
                assert shown == pytest.approx(T, abs=1e-4)


def test_parts_and_contact_shapes_are_never_drawn_together(opened: Page):
    seen = "[...new Set(fpcad.stage.hand.{}.map((mesh) => mesh.visible))]"
    for wanted in (True, False, True):
        opened.locator("#player input[type=checkbox]").set_checked(wanted)
        assert opened.evaluate(seen.format("parts")) == [wanted]
        assert opened.evaluate(seen.format("shown")) == [not wanted]


def test_playing_moves_the_tool_and_pauses(opened: Page):
    opened.locator("#player .play").click()
    start = opened.evaluate("fpcad.player.frame")
    opened.wait_for_function("(start) => fpcad.player.frame !== start", arg=start)
    opened.locator("#player .play").click()
    assert opened.locator("#player .play").inner_text() == "Play"


def test_a_filter_lets_pass_what_lies_inside(opened: Page, real_run: Run):
    column = next(c for c in real_run.score_columns if c.name.endswith("tmr_score"))
    scores = real_run.matrix([column.name])[:, 0]
    opened.locator("summary", has_text="Filters").click()
    opened.get_by_label(f"{column.label}, at least").fill("50")
    opened.keyboard.press("Enter")
    passing = opened.evaluate("Array.from(fpcad.state.passing)")
    assert passing == [int(score >= 50) for score in scores]


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_fits_and_its_picture_is_kept(browser: Browser, real_page: Path, width, scheme):
    tab = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    show(tab, real_page)
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    height = tab.evaluate("document.documentElement.scrollHeight")
    for k, top in enumerate(range(0, height, SLICE)):
        file = SCREENSHOTS / f"report-{width}-{scheme}-{k + 1}.png"
        slice_height = min(SLICE, height - top)
        part = FloatRect(x=0, y=top, width=width, height=slice_height)
        tab.screenshot(path=file, full_page=True, clip=part)
    tab.close()


def test_words_of_a_spec_are_shown_and_not_run(page: Page, made_up: Run, tmp_path: Path):
    evil = "</script><script>document.title='owned'</script><img src=x onerror=alert(1)>"
    spec = made_up.spec.model_copy(update={"description": evil})
    run = replace(made_up, spec=spec)
    file = tmp_path / "report.html"
    file.write_text(report_page(run), encoding="utf-8")
    show(page, file)
    assert page.title() == "clay: design space"
    assert evil in page.locator("header").inner_text()


def test_runs_on_motors_are_drawn(page: Page, made_up: Run, tmp_path: Path):
    folder = Path(shutil.copytree(made_up.folder, tmp_path / "clay"))
    write_log(folder, "carve.parquet", log_table())
    show(page, write_report(folder))
    assert "5.73 ° (thumb_mcp_flex)" in page.locator("section:has(.log)").inner_text()
    curves = page.locator(".log path.curve")
    curves.first.wait_for(state="attached")
    assert curves.count() == 1
    page.locator("#log-controls select").select_option("position")
    page.locator(".log figure").first.scroll_into_view_if_needed()
    curves.nth(1).wait_for(state="attached")
    legend = page.locator(".log .legend").inner_text()
    assert "mcp flex measured" in legend
    assert "mcp flex command" in legend


def test_numbers_of_the_page_are_the_tables(opened: Page, real_run: Run):
    scores = opened.evaluate("fpcad.run.scores.map((s) => [s.name, Array.from(s.data)])")
    for name, values in scores:
        assert values == pytest.approx(real_run.matrix([name])[:, 0], rel=1e-6)
    assert json.dumps([name for name, _ in scores]) == json.dumps(
        [column.name for column in real_run.score_columns]
    )
