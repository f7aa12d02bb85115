"""Re-check random candidates of a build with code of its own, and some of them with IPOPT.

.venv/bin/python benchmarks/recheck.py build/paper-6d
"""

from __future__ import annotations

import sys
from pathlib import Path

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))
    from benchmarks.paper.recheck_command import main

    main()
