"""The same replications by both engines: whether their rows are the same in every bit, and how long each took."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.engine.choice import FAST, REFERENCE, Choice, make_ready
from opsim.engine.difference import Difference, difference
from opsim.plan import Plan
from opsim.study.engine_choice import Chosen, engines_of
from opsim.study.timed import Timed, timed

Progress = Callable[[int, int], None]
HINT = "only the SimPy engine runs it, so there is nothing to compare"


@dataclass(frozen=True)
class Both:
    """What came of a variant: ``rows`` of all replications that were run, seconds of each engine without compiling.

    replication : the last one that was run: the one with the difference, where there is one
    ended : in words, which engine alone came to no end of it; nothing where both did
    """

    variant: str
    replication: int
    rows: int
    simpy_s: float
    fast_s: float
    difference: Difference | None = None
    ended: str = ""

    @property
    def same(self) -> bool:
        """In every bit of every row."""
        return self.difference is None and not self.ended

    @property
    def words(self) -> str:
        """What was found."""
        if not self.same:
            return f"replication {self.replication}: {self.ended if self.difference is None else self.difference.said}"
        n = self.replication + 1
        return f"the same {self.rows:,} rows" + (f" in {n} replications" if n > 1 else "")

    @property
    def times(self) -> str:
        """How many times as fast the fast engine was."""
        return f"{self.simpy_s / self.fast_s:.3g}" if self.fast_s > 0 else ""

    def as_json(self) -> dict[str, Any]:
        """For machines."""
        seconds = {"simpy_s": self.simpy_s, "fast_s": self.fast_s}
        said = {"variant": self.variant, "same": self.same, "replications": self.replication + 1, "rows": self.rows}
        said |= seconds | ({"ended": self.ended} if self.ended else {})
        return said | ({} if self.difference is None else {"difference": self._difference(self.difference)})

    def _difference(self, differ: Difference) -> dict[str, Any]:
        cells = {cell.column: [cell.one, cell.other] for cell in differ.cells()}
        where = {"replication": self.replication, "row": differ.row, "said": differ.said, "columns": differ.columns}
        return where | {"row_by_simpy_and_fast": cells}


def planned(
    file: str, names: Sequence[str] = (), seed: int | None = None, horizon: str | None = None
) -> dict[str, tuple[Any, Plan]]:
    """(as read, Plan) of the variants of a file. Raises ScenarioError, ValueError, OSError."""
    from opsim.plan import compile_plan
    from opsim.scenario import read_scenarios

    changes = {} if horizon is None else {"run.horizon": horizon}
    loaded = read_scenarios(file, list(names) or None, changes, "command line")
    return {name: (one, compile_plan(one, seed=seed)) for name, one in loaded.items()}


def both_engines(
    variants: Mapping[str, tuple[Any, Plan]],
    replications: int = 1,
    progress: Progress | None = None,
    chosen: Chosen | None = None,
) -> list[Both]:
    """Each variant as far as its first difference. Raises ScenarioError where the fast engine does not run one, and
    what both engines raise.
    """
    choices = engines_of(FAST, variants, dict.fromkeys(variants, replications), hint=HINT)
    for name, (_, plan) in variants.items():
        make_ready(choices[name], plan, None if chosen is None else chosen(choices[name]))
    total, found = len(variants) * replications, list[Both]()
    for place, (name, (_, plan)) in enumerate(variants.items()):
        told = lambda done, before=place * replications: progress and progress(before + done, total)  # noqa: E731
        found.append(_compared(name, plan, replications, choices[name], told))
    return found


def _compared(
    name: str, plan: Plan, replications: int, fast: Choice, told: Callable[[int], Any] = lambda done: None
) -> Both:
    rows, simpy_s, fast_s = 0, 0.0, 0.0
    for replication in range(replications):
        one, other = timed(REFERENCE, plan, replication), timed(fast, plan, replication)
        rows, simpy_s, fast_s = rows + one.rows, simpy_s + one.seconds, fast_s + other.seconds
        ended = _ended(one, other)
        differ = next(filter(None, (difference(one.logs[0], log) for log in other.logs)), None) if not ended else None
        told(replications if ended or differ else replication + 1)
        if ended or differ:
            break
    return Both(name, replication, rows, simpy_s, fast_s, differ, ended)


def _ended(simpy: Timed, fast: Timed) -> str:
    """Which engine alone ended with an error, or with another one; nothing where none did. Raises that of both."""
    if simpy.error is None and fast.error is None:
        return ""
    if simpy.error is not None and simpy.said == fast.said:
        raise simpy.error
    return f"simpy {simpy.words}, fast {fast.words}"
