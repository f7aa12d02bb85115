"""report.html: one self-contained page of a run."""

from __future__ import annotations

import base64
import hashlib
import json
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined

from fpcad.look.document import OPENING, build_document
from fpcad.look.logs import run_logs
from fpcad.look.run import Run, load
from fpcad.look.words import summarize
from fpcad.store import write_whole

FILE = "report.html"
SCRIPTS = ("report.first.js", "report.3d.js", "report.js")
"""In the order of the page: the first stands before the data, the last runs the second."""
MAX_BYTES = 15_000_000
"""What a page of 10,000 candidates stays under."""


def write_report(folder: Path) -> Path:
    """Write build/NAME/report.html from what the build folder holds."""
    return write_whole(folder / FILE, report_page(load(folder)))


def report_page(run: Run, token: str = "") -> str:
    """The page as HTML. It holds its script, its style and all of its data, and loads nothing.

    Texts of the spec are escaped, and the page's policy lets no script run but its own.

    Args:
        run: the run.
        token: what the live view's page shows to its server; with one, the page asks that server
            for paths.
    """
    warnings: list[str] = []
    logs = run_logs(run.folder, warnings)
    document, blocks = build_document(run, logs)
    document["token"] = token
    page = files("fpcad.look") / "page"
    template = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    return template.from_string((page / "report.html").read_text(encoding="utf-8")).render(
        summary=summarize(run, document, logs, warnings),
        document=document,
        version=version("fpcad"),
        style=(page / "report.css").read_text(encoding="utf-8"),
        scripts=[_script((page / name).read_text(encoding="utf-8")) for name in SCRIPTS],
        run_json=_for_script(document),
        blocks=blocks,
        opening=OPENING,
        live=bool(token),
    )


def _script(text: str) -> dict[str, str]:
    """A script and the hash by which the page's policy knows it."""
    return {"text": text, "hash": base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}


def _for_script(value: object) -> str:
    """JSON that cannot end the script element that holds it."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
