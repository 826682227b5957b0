"""State-dependent pace: people go faster where they hold others up."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import ClassVar

from opsim.human.parameter import Checked, parameter


@dataclass(frozen=True, slots=True)
class Schultz(Checked):
    """The shift of log time is -faster * max(0, before - after) + slower * max(0, after - before).

    before, after : how full the buffers before and behind the station are, 0 empty, 1 full; a side where nobody is
    held up counts as ``NEUTRAL_SHARE``. So who has a full buffer before him and an empty one behind him takes
    exp(-faster) of his time.

    He is seen as he begins: without any buffers nobody waits for him then, and he goes at his own pace.

    Source: Schultz et al. (1998), who saw people speed up where they were the cause of idle time, enough to make up for
    all that blocking and starving had cost, and Schultz, Juran & Boudreau (1999). Neither gives a formula: that it is
    linear in the difference of shares, and the defaults, are assumptions.
    """

    does: ClassVar[str] = "people speed up where the buffer before them is fuller than the one behind them"
    source: ClassVar[str] = (
        "Schultz, K. L., Juran, D. C., Boudreau, J. W., McClain, J. O. & Thomas, L. J. (1998). Modeling and worker "
        "motivation in JIT production systems. Manage. Sci. 44, 1595-1607"
    )
    faster: float = parameter(
        0.1,
        "log of time won where the buffer before is full and the one behind empty",
        neutral=0.0,
        at_least=0.0,
        at_most=2.0,
    )
    slower: float = parameter(
        0.0,
        "log of time lost where the buffer before is empty and the one behind full",
        neutral=0.0,
        at_least=0.0,
        at_most=2.0,
    )
    full_at: float = parameter(10.0, "jobs that fill a buffer without limit", unit="jobs", above=0.0)

    def shift(self, before: float, after: float) -> float:
        """By how much log time shifts, given how full the buffers are."""
        ahead = before - after
        return self.slower * max(0.0, -ahead) - self.faster * max(0.0, ahead)

    def share(self, waiting: float, places: float) -> float:
        """How full a buffer is: 1 where somebody waits for one that does not exist."""
        room = min(places, self.full_at) if places == inf else places
        if room <= 0.0:
            return 1.0 if waiting > 0 else 0.0
        return min(1.0, waiting / room)


NEUTRAL_SHARE = 0.5
"""Of a side where nobody is held up: before stations that take from outside only, behind those that jobs leave from."""
