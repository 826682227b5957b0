"""An item of the STRESS-DES checklist."""

from __future__ import annotations

from dataclasses import dataclass

YOURS, RUN, BOTH = "to be written by you", "filled from the run", "begun by the run, yours to finish"


@dataclass(frozen=True)
class Item:
    """number : as in the guidelines; said : what the run knows, "" for nothing; by : YOURS, RUN or BOTH"""

    number: str
    title: str
    said: str
    by: str = RUN


def counted(n: int, one: str, many: str = "") -> str:
    """``1 worker``, ``3 workers``; "" for none."""
    return f"{n} {one if n == 1 else many or one + 's'}" if n else ""
