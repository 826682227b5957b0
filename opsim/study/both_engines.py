"""The same replications by both engines: whether their rows are the same in every bit, and how long each took."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.engine.choice import FAST, REFERENCE, Choice, Run, make_ready, runner_of
from opsim.engine.difference import Difference, difference
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.study.engine_choice import Chosen, engines_of

Progress = Callable[[int, int], None]
QUICK_S = 2.0


@dataclass(frozen=True)
class Both:
    """What came of a variant: ``rows`` of all replications that were run, seconds of each engine without compiling.

    replication : the last one that was run: the one with the difference, where there is one
    """

    variant: str
    replication: int
    rows: int
    simpy_s: float
    fast_s: float
    difference: Difference | None = None

    @property
    def same(self) -> bool:
        """In every bit of every row."""
        return self.difference is None

    @property
    def words(self) -> str:
        """What was found."""
        if self.difference is not None:
            return f"replication {self.replication}: {self.difference.said}"
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
        return said | seconds | ({} if self.difference is None else {"difference": self._difference(self.difference)})

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
    """Each variant as far as its first difference. Raises ScenarioError where the fast engine does not run one."""
    choices = engines_of(FAST, variants, replications)
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
        one, one_s = _timed(REFERENCE, plan, replication)
        other, other_s = _timed(fast, plan, replication)
        rows, simpy_s, fast_s = rows + len(one), simpy_s + one_s, fast_s + other_s
        differ = difference(one, other)
        told(replication + 1 if differ is None else replications)
        if differ is not None:
            break
    return Both(name, replication, rows, simpy_s, fast_s, differ)


def _timed(choice: Choice, plan: Plan, replication: int) -> tuple[EventLog, float]:
    """The log, and seconds; of a quick first run those of a second one, as the first also loads what it needs."""
    run = runner_of(choice)
    first = _once(run, plan, replication)
    return _once(run, plan, replication) if replication == 0 and first[1] < QUICK_S else first


def _once(run: Run, plan: Plan, replication: int) -> tuple[EventLog, float]:
    started = time.perf_counter()
    log = run(plan, replication)
    return log, time.perf_counter() - started
