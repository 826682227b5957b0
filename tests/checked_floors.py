"""Runs of made floors, once what holds of any has held: laws, figures, the order of declaration, locks foretold."""

from __future__ import annotations

import re
from random import Random

import numpy as np
from made.floors import FOLDER, text_of

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.kpi.deadlock import locked
from opsim.laws.audit import CHECKS, audit
from opsim.log import COLUMNS, EventLog
from opsim.plan import Plan, compile_plan
from opsim.plan.warnings import risks_of
from opsim.scenario.read import scenarios_in
from opsim.scenario.schema.scenario import Loaded

LOCKS = re.compile(r"nothing moves any more|for ever|never fills|cannot be finished")
"""What ``opsim check`` says of a floor that may lock itself."""


def loaded(text: str) -> Loaded:
    return scenarios_in(text.encode(), FOLDER / "made.yaml")["base"]


def plan_of(text: str) -> Plan:
    return compile_plan(loaded(text))


def differ(a: EventLog, b: EventLog) -> list[str]:
    """The columns in which two logs are not the same, or that they have not as many rows."""
    if len(a) != len(b):
        return ["rows"]
    return [c for c in COLUMNS if not np.array_equal(a[c], b[c], equal_nan=a[c].dtype.kind == "f")]


def checked(values: dict, shuffle: int) -> tuple[EventLog, Plan]:
    """The log of a scenario; ``shuffle`` : the order of declaration in which it is run once more."""
    read = loaded(text_of(values))
    plan = compile_plan(read)
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    assert [figure for figure in figures(log, plan) if figure.value < -1e-9] == []
    again = run_plan(plan_of(text_of(values, Random(shuffle))))
    assert again.names == log.names
    assert differ(log, again) == [], "the order of declaration decides something"
    lock = locked(log, plan)
    assert lock is None or any(LOCKS.search(risk) for risk in risks_of(read.scenario)), lock
    return log, plan
