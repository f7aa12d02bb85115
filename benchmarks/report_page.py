"""How fast the page of a run of 10,000 hands is made, opens, and answers a click.

    python -m benchmarks.report_page [HANDS]

The hands are made up. Opening is told by the browser's own clock, from the start of the navigation in a
browser that has come to rest, as medians of 15: when the summary is painted, when the page can answer, when
another hand, picked at that moment, is shown, when the chosen hand stands in 3D, when all figures are drawn
and all paths are there. A page of one word, opened in turn with it, tells what the machine and its browser
take for any page. Beside each time stands the time that the page's own thread worked until then, which
other work on the machine does not lengthen. Times of clicks are medians of 20, from the click's event to
the frame that shows all marks and the other hand.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import Browser, sync_playwright

from fpcad.look.report import write_report
from fpcad.spec.load import load_spec
from tests.look.conftest import BROWSERS, FLAGS, PATIENCE_MS
from tests.look.made_up import write_made_up_run

CLAY = Path(__file__).parents[1] / "designs" / "clay.yaml"
OPENINGS = 15
SETTLED_MS = 1500
"""A new window's own work is over by then."""
PAINTED = "firstContentfulPaint"
EVENTS = {
    PAINTED: "summary painted",
    "fpcad:answers": "the page can answer",
    "benchmark:picked": "another hand is picked",
    "benchmark:answered": "that hand is shown",
    "fpcad:stage": "a hand in 3D",
    "fpcad:whole": "everything drawn and read",
}
PICK = """
const mark = performance.mark.bind(performance);
performance.mark = (name) => {
  mark(name);
  if (name === "fpcad:answers") setTimeout(pick);
};
function pick() {
  mark("benchmark:picked");
  const field = document.getElementById("pick"), other = field.value === "7" ? "8" : "7";
  field.value = other;
  field.dispatchEvent(new Event("change"));
  const painted = new MessageChannel(); // a timer would come behind the script's next piece of work
  painted.port1.onmessage = () => {
    const title = document.getElementById("selected-title").textContent;
    if (title === `Hand ${other}`) mark("benchmark:answered");
  };
  requestAnimationFrame(() => painted.port2.postMessage(null));
}"""
TRACED = ["toplevel", "blink.user_timing", "loading"]
Times = dict[str, tuple[float, float]]
"""Milliseconds from the start of the navigation, and of the thread's work, to each event."""
CLICKS = """async () => {
  const plot = fpcad.figures.find((f) => f.box.closest("#pareto")), count = fpcad.state.count;
  const handled = [], shown = [];
  const shownFrame = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  for (let k = 1; k <= 20; k++) {
    const box = plot.box.getBoundingClientRect(), [x, y] = plot.place((k * 487) % count);
    await shownFrame();
    const start = performance.now();
    plot.box.dispatchEvent(new MouseEvent("click", { clientX: box.left + x, clientY: box.top + y }));
    handled.push(performance.now() - start);
    await shownFrame();
    shown.push(performance.now() - start);
  }
  const median = (v) => v.sort((a, b) => a - b)[Math.floor(v.length / 2)];
  return [median(handled), median(shown), Math.max(...shown)];
}"""


def main(hands: int) -> None:
    """Print the figures, one a line."""
    with tempfile.TemporaryDirectory() as folder:
        spec = load_spec(CLAY)
        run = write_made_up_run(Path(folder) / "clay", spec, hands, states=100)
        started = time.perf_counter()
        page = write_report(run)
        print(f"{hands} hands: page of {page.stat().st_size / 1e6:.1f} MB made", end=" ")
        print(f"in {time.perf_counter() - started:.1f} s")
        word = Path(folder) / "word.html"
        word.write_text("<!DOCTYPE html><title>word</title><p>word</p>", encoding="utf-8")
        measure_browser(page, word)


def measure_browser(file: Path, word: Path) -> None:
    """Open the page and the word's in turn, and click."""
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        plain, opened = [], []
        for _ in range(OPENINGS):
            plain.append(open_once(browser, word, "p"))
            opened.append(open_once(browser, file, "html[data-ready]"))
        tell("a word painted on an empty page: {}", [times[PAINTED] for times in plain])
        for name, told in EVENTS.items():
            tell(f"{told}: {{}}", [times[name] for times in opened])
        measure_clicks(browser, file)
        print(f"load of this machine: {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
        browser.close()


def open_once(browser: Browser, file: Path, wanted: str) -> Times:
    """Open a page in a window that has come to rest."""
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.set_default_timeout(PATIENCE_MS)
    tab.add_init_script(PICK)
    tab.wait_for_timeout(SETTLED_MS)
    browser.start_tracing(page=tab, categories=TRACED)
    tab.goto(file.as_uri())
    tab.wait_for_selector(wanted, state="attached")
    tab.wait_for_function("performance.getEntriesByName('first-contentful-paint').length")
    times = opening_times(json.loads(browser.stop_tracing())["traceEvents"], file.name)
    tab.close()
    return times


def measure_clicks(browser: Browser, file: Path) -> None:
    """Click on 20 hands of the front's figure."""
    tab = browser.new_page(viewport={"width": 1280, "height": 900})
    tab.set_default_timeout(PATIENCE_MS)
    tab.goto(file.as_uri())
    tab.wait_for_selector("html[data-ready]", state="attached")
    tab.wait_for_timeout(2 * SETTLED_MS)
    handled, shown, worst = tab.evaluate(CLICKS)
    print(f"click: handled in {handled:.0f} ms, shown in {shown:.0f} ms, at worst {worst:.0f} ms")


def tell(sentence: str, times: Sequence[tuple[float, float]]) -> None:
    """Print median and range of the time passed, and the median of the thread's work [ms]."""
    passed, worked = (sorted(column) for column in zip(*times, strict=True))
    figures = f"{median(passed):.0f} ms ({passed[0]:.0f} to {passed[-1]:.0f})"
    print(sentence.format(f"{figures}, {median(worked):.0f} ms of work"))


def opening_times(trace: list[dict[str, Any]], name: str) -> Times:
    """When each event of an opening came, and how long the page's thread had worked [ms]."""
    starts = [e for e in trace if e["name"] == "navigationStart" and address(e).endswith(name)]
    start = max(starts, key=lambda e: e["ts"])
    page = [e for e in trace if (e["pid"], e["tid"]) == (start["pid"], start["tid"])]
    page = [e for e in page if e["ts"] >= start["ts"]]
    tasks = [e for e in page if "RunTask" in e["name"] and e["ph"] == "X"]
    return {
        e["name"]: ((e["ts"] - start["ts"]) / 1000, sum(worked(t, e) for t in tasks) / 1000)
        for e in page
        if e["name"] in EVENTS
    }


def address(event: dict[str, Any]) -> str:
    """Of the document whose navigation started."""
    return event["args"].get("data", {}).get("documentLoaderURL", "")


def worked(task: dict[str, Any], event: dict[str, Any]) -> float:
    """Processor time [us] that a task of the page's thread took before an event."""
    passed, took = event["ts"] - task["ts"], task.get("tdur", 0.0)
    if "tts" in event and "tts" in task and 0 < passed < task["dur"]:
        return event["tts"] - task["tts"]
    return took * min(max(passed / max(task["dur"], 1), 0.0), 1.0)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
