"""The engine of each variant of a scenario; what the fast one does not run is said with its place, all at once.

The same replications by both engines: whether their rows are the same in every bit, and how long each took.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from opsim.engine.choice import (
    AUTO,
    FAST,
    REFERENCE,
    Choice,
    NotFast,
    Refusal,
    Told,
    able_to,
    make_ready,
    simpy_s,
    worth,
)
from opsim.engine.difference import Difference, difference
from opsim.plan import Plan
from opsim.pool import cores
from opsim.problems import Problem, ScenarioError
from opsim.scenario.templates import without_likes
from opsim.scenario.tree import Node, child, problem
from opsim.study.replication import Timed, timed

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded

Chosen = Callable[[Choice], Told | None]
"""Is told which engine is used; what it gives back, if anything, is told how far the compiling is."""
HINT = "--engine simpy runs it, and --engine auto finds that out by itself"


def engine_of(
    asked: str | Choice, loaded: Loaded, plan: Plan, runs: int = 1, *, processes: int | None = None
) -> Choice:
    """The engine of one variant; a Choice stays what it is. Raises ScenarioError, ValueError for an unknown word."""
    if isinstance(asked, Choice):
        return asked
    return engines_of(asked, {"": (loaded, plan)}, {"": runs}, processes=processes)[""]


def engines_of(
    asked: str,
    variants: Mapping[str, tuple[Any, Plan]],
    runs: Mapping[str, int],
    *,
    processes: int | None = None,
    hint: str = HINT,
) -> dict[str, Choice]:
    """The engine of each variant, (as read, its Plan) by name; runs : replications of each that are to be made

    Raises ScenarioError with everything in them that the fast engine does not run, where it is asked for; hint : the
    way out.
    """
    able, wrong = dict[str, Choice](), list[Problem]()
    for name, (loaded, plan) in variants.items():
        try:
            able[name] = able_to(asked, plan)
        except NotFast as error:
            wrong += problems_of(error, tree_of(loaded), loaded.file, hint)
    if wrong:
        raise ScenarioError(dict.fromkeys(wrong))
    if asked != AUTO:
        return able
    fast = [name for name, choice in able.items() if choice.engine == FAST]
    waited_s = sum(_simpy_clock_s(variants[name][1], runs[name], processes) for name in fast)
    of = f" for {len(fast)} variants" if len(fast) > 1 else ""
    return {name: worth(choice, variants[name][1], waited_s, of=of) for name, choice in able.items()}


def _simpy_clock_s(plan: Plan, runs: int, processes: int | None) -> float:
    """Seconds of so many replications by SimPy, on all cores that they may use."""
    return simpy_s(plan) * runs / max(1, min(runs, processes or cores()))


def compiled_for(choice: Choice, plan: Plan, chosen: Chosen | None) -> None:
    """Tell of a choice, and make it ready for a Plan."""
    make_ready(choice, plan, None if chosen is None else chosen(choice))


def problems_of(error: NotFast, tree: Node | None, file: Path, hint: str = HINT) -> list[Problem]:
    """Each with its place in the scenario, where it has one."""
    return [one for refusal in error.refusals for one in _problems(refusal, tree, file, hint)]


def tree_of(loaded: Loaded) -> Node | None:
    """What stands in the file of a variant, ``like`` filled in; None where the file is not there or is another now."""
    from opsim.scenario.read import variant_trees

    try:
        name, trees, _ = variant_trees(loaded.file, loaded.variant)
    except (ScenarioError, OSError):
        return None
    return without_likes(trees[name])[0]


def _problems(refusal: Refusal, tree: Node | None, file: Path, hint: str) -> Iterable[Problem]:
    """One at each place that says so; else one of the whole file."""
    message = f"the fast engine does not run this: {refusal.words}"
    nodes = {path: node for path in refusal.places if _says(node := child(tree, *path), refusal)}
    said = [problem(node.place, path, message, hint) for path, node in nodes.items() if node is not None]
    return said or [Problem(str(file), 0, 0, "", message, hint)]


def _says(node: Node | None, refusal: Refusal) -> bool:
    return node is not None and isinstance(node.value, str) and repr(node.value) in refusal.words


Progress = Callable[[int, int], None]
NOTHING_TO_COMPARE = "only the SimPy engine runs it, so there is nothing to compare"


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
    choices = engines_of(FAST, variants, dict.fromkeys(variants, replications), hint=NOTHING_TO_COMPARE)
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
