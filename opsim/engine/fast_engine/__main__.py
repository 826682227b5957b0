"""``python -m opsim.engine.fast_engine``: compile all of the engine ahead, for an image or before tests.

Else each floor compiles what it needs when it is first run.
"""

from __future__ import annotations

import sys

from opsim.engine.fast_engine.machine.steps import STEPS
from opsim.engine.fast_engine.machine.table import complete


def main() -> int:
    """Every step that there is."""
    complete()
    print(f"{len(STEPS)} steps are ready")
    return 0


if __name__ == "__main__":
    sys.exit(main())
