"""``pytest --both-engines``: whatever a test has the SimPy engine run, the fast engine runs as well, to the same rows.

A test fails where the logs differ, where only one engine raises, or where the fast one refuses what is not Python of
others; at the end stands how many runs were equal, and what the fast engine does not run.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from opsim.log import EventLog
from opsim.plan import Plan

Run = Callable[..., EventLog]
EQUAL, DIFFERENT, REFUSED = "equal", "different", "not run by the fast engine: "
OF_OTHERS = ("is a plug-in in Python", "the human effect ")
"""Words of what it may refuse: rules that are plug-ins, and effects of which there is only Python."""


class BothEngines:
    """The plug-in of pytest. runs : how many were equal or different, and for what reasons only SimPy ran"""

    def __init__(self) -> None:
        self.runs: Counter[str] = Counter()

    def plant(self) -> None:
        """From now on ``run_plan`` of the SimPy engine is that of both: before a test module imports it."""
        from opsim.engine import fast_engine, floor
        from opsim.engine.floor import run as home

        twice = doubled(floor.run_plan, fast_engine.run_plan, fast_engine.unsupported, self.runs)
        floor.run_plan = home.run_plan = twice

    def pytest_sessionfinish(self, session: Any) -> None:
        if hasattr(session.config, "workeroutput"):  # one of several processes: the first one tells
            session.config.workeroutput["both_engines"] = dict(self.runs)

    @pytest.hookimpl(optionalhook=True)  # of xdist
    def pytest_testnodedown(self, node: Any) -> None:
        self.runs.update(getattr(node, "workeroutput", {}).get("both_engines", {}))

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        terminalreporter.write_sep("-", "runs by both engines")
        for words, n in sorted(self.runs.items()):
            terminalreporter.write_line(f"{n:>7,} {words}")


def doubled(reference: Run, other: Run, unsupported: Callable[[Plan], Sequence[str]], runs: Counter[str]) -> Run:
    """The reference, with the other engine as its shadow; ``runs`` counts. Raises AssertionError where they differ, or
    the other one refuses what it ought to run.
    """
    from engine_evidence.rows import first_difference

    def run_plan(plan: Plan, replication: int = 0) -> EventLog:
        log, refusal = _tried(reference, plan, replication)
        if words := unsupported(plan):
            runs.update(REFUSED + word for word in words)
            ours = [word for word in words if not any(said in word for said in OF_OTHERS)]
            assert not ours, f"the fast engine does not run what is ours: {'; '.join(ours)}"
        else:
            also, other_refusal = _tried(other, plan, replication)
            differs = (
                first_difference(log, also) if log is not None and also is not None else _apart(refusal, other_refusal)
            )
            runs[DIFFERENT if differs else EQUAL] += 1
            assert not differs, f"the engines differ: {differs}"
        if refusal is not None:
            raise refusal
        return log

    return run_plan


def _tried(run: Run, plan: Plan, replication: int) -> tuple[Any, Exception | None]:
    try:
        return run(plan, replication), None
    except Exception as error:  # of a plan that cannot be run: the other engine must not run it either
        return None, error


def _apart(refusal: Exception | None, other: Exception | None) -> str:
    """How two ends of a run differ of which one at least is no log."""
    one, two = (f"{type(error).__name__}: {error}" if error else "a log" for error in (refusal, other))
    return "" if one == two else f"{one}; {two}"
