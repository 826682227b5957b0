"""A small scenario run by both engines: what the fast one writes is what the reference writes, to the last bit."""

from engine_evidence.rows import first_difference
from plans import plan

from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor.run import run_plan as run_simpy
from opsim.log import EventLog
from opsim.plan import Plan


def twins(text: str, *edits: tuple[str, str], replication: int = 0) -> EventLog:
    """The log of a scenario with some of its words replaced. Both engines write it, or the test fails here."""
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    return of_both(plan(text), replication)


def of_both(made: Plan, replication: int = 0) -> EventLog:
    """The log of a plan. Both engines write it, or the test fails here: the fast one also where it draws ahead."""
    log = run_simpy(made, replication)
    assert [first_difference(log, run_fast(made, replication)) for _ in range(2)] == ["", ""]
    return log
