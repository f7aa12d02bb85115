"""Stage report: one page to look at the run with."""

from __future__ import annotations

from fpcad.look.report import FILE, write_report
from fpcad.pipeline.stage import Build, Counts, Stage


def report(build: Build) -> Counts:
    """Write report.html from what the stages before left in the build folder."""
    with build.reporter.stage("report", None):
        page = write_report(build.folder)
    return {"bytes": page.stat().st_size}


REPORT = Stage("report", (), ("look",), (FILE,), report)
