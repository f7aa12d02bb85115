"""Run the paper's two experiments, the control group and the re-check; write docs/results.md.

    .venv/bin/python benchmarks/paper_experiments.py
    .venv/bin/python benchmarks/paper_experiments.py --candidates 100    # a trial, docs/ untouched

Builds that are up to date are used as they are, and what was interrupted goes on where it was.
"""

from __future__ import annotations

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from benchmarks.paper.command import main

    main()
