"""How fast the page of a run of 10,000 hands is made, opens, and answers a click.

    python -m benchmarks.report_page [HANDS]

The hands are made up. Opening is told by the browser's own clock, from the start of the navigation, as
medians of five: when the summary is painted, when a click is answered and marked in the figures, when the
chosen hand stands in 3D, when all figures are drawn and all paths are there. Beside it stands the time
that the page's own thread worked until then, which other work on the machine does not lengthen. Times of
clicks are medians of 20, from the click's event to the frame that shows all marks and the other hand.
"""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import sync_playwright

from fpcad.look.report import write_report
from fpcad.spec.load import load_spec
from tests.look.conftest import BROWSERS, FLAGS, PATIENCE_MS
from tests.look.made_up import write_made_up_run

CLAY = Path(__file__).parents[1] / "designs" / "clay.yaml"
OPENINGS = 5
EVENTS = {
    "firstContentfulPaint": "summary painted",
    "fpcad:answers": "clicks are answered",
    "fpcad:stage": "chosen hand in 3D",
    "fpcad:whole": "everything drawn and read",
}
TRACED = ["toplevel", "blink.user_timing", "loading"]
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
        measure_browser(page)


def measure_browser(file: Path) -> None:
    """Open the page five times, and click."""
    program = next(filter(None, map(shutil.which, BROWSERS)))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=FLAGS)
        opened = []
        for attempt in range(OPENINGS):
            tab = browser.new_page(viewport={"width": 1280, "height": 900})
            tab.set_default_timeout(PATIENCE_MS)
            browser.start_tracing(page=tab, categories=TRACED)
            tab.goto(file.as_uri())
            tab.wait_for_selector("html[data-ready]", state="attached")
            opened.append(opening_times(json.loads(browser.stop_tracing())["traceEvents"]))
            if attempt < OPENINGS - 1:
                tab.close()
        for name, told in EVENTS.items():
            times = [attempt[name] for attempt in opened]
            passed, worked = (sorted(column) for column in zip(*times, strict=True))
            print(
                f"{told}: {median(passed):.0f} ms ({passed[0]:.0f} to {passed[-1]:.0f}), "
                f"{median(worked):.0f} ms of work"
            )
        tab.wait_for_timeout(3000)
        handled, shown, worst = tab.evaluate(CLICKS)
        print(
            f"click: handled in {handled:.0f} ms, shown in {shown:.0f} ms, at worst {worst:.0f} ms"
        )
        print(f"load of this machine: {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
        browser.close()


def opening_times(trace: list[dict[str, Any]]) -> dict[str, tuple[float, float]]:
    """When each event of an opening came, and how long the page's thread had worked [ms]."""
    answers = next(e for e in trace if e["name"] == "fpcad:answers")
    page = [e for e in trace if e["pid"] == answers["pid"] and e["tid"] == answers["tid"]]
    starts = [e["ts"] for e in page if e["name"] == "navigationStart" and e["ts"] < answers["ts"]]
    tasks = [e for e in page if "RunTask" in e["name"] and e["ph"] == "X" and e["ts"] > max(starts)]
    return {
        e["name"]: ((e["ts"] - max(starts)) / 1000, sum(worked(t, e) for t in tasks) / 1000)
        for e in page
        if e["name"] in EVENTS
    }


def worked(task: dict[str, Any], event: dict[str, Any]) -> float:
    """Processor time [us] that a task of the page's thread took before an event."""
    passed, took = event["ts"] - task["ts"], task.get("tdur", 0.0)
    if "tts" in event and "tts" in task and 0 < passed < task["dur"]:
        return event["tts"] - task["tts"]
    return took * min(max(passed / max(task["dur"], 1), 0.0), 1.0)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
