"""``python -m opsim.engine.fast_engine``: compile all of the engine ahead, for an image or before tests.

Else each floor compiles what it needs when it is first run.
"""

from __future__ import annotations

import sys

from opsim.engine.fast_engine import lowering
from opsim.engine.fast_engine.machine.steps import STEPS
from opsim.engine.fast_engine.machine.table import lacking
from opsim.engine.fast_engine.run import ready_for


def main() -> int:
    """Every step that there is; how many were compiled."""
    lowering.know_all()
    n_compiled = len(lacking(STEPS.values()))
    ready_for(STEPS.values())
    print(f"{len(STEPS)} steps are ready, {n_compiled} of them compiled now")
    return 0


if __name__ == "__main__":
    sys.exit(main())
