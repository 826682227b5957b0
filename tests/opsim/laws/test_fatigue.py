from dataclasses import replace

import numpy as np
import pytest
from human_plans import LINE, planned

from opsim.engine.floor import run_plan
from opsim.laws.effects import rests, shifts
from opsim.log import BREAK, REST, WORK

FATIGUE = "fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min, slows: 0.5}"


@pytest.fixture(scope="module")
def ran():
    plan = planned(LINE, f"human: {{{FATIGUE}, circadian: {{amplitude: 0.1}}, rest: {{above: 0.4, until: 0.2}}}}")
    return run_plan(plan), plan


def said(law, log, plan):
    return "; ".join(law(log, plan, None))


def with_column(log, name, change):
    columns = {**log.columns, name: log[name].copy()}
    change(columns[name])
    return replace(log, columns=columns)


def test_a_run_obeys_both_laws(ran):
    assert said(shifts, *ran) == said(rests, *ran) == ""


def test_a_shift_that_nobodys_day_made_is_found(ran):
    log, plan = ran
    row = np.flatnonzero(log["kind"] == WORK)[30]
    wrong = with_column(log, "pace_shift", lambda shift: shift.__setitem__(row, shift[row] + 1e-6))
    assert "log time is shifted by" in said(shifts, wrong, plan)


def test_it_is_not_asked_where_effects_are_plain_factors(ran):
    log, plan = ran
    wrong = with_column(log, "pace_shift", lambda shift: shift.fill(0.3))
    assert said(shifts, wrong, replace(plan, human=replace(plan.human, acts_on="time"))) == ""


def test_a_rest_of_somebody_who_is_not_tired_is_found(ran):
    log, plan = ran
    assert "and his fatigue was" in said(rests, log, replace(plan, human=replace(plan.human, rest=Levels(0.9, 0.2))))


def test_a_rest_that_ends_too_soon_is_found(ran):
    log, plan = ran
    row = np.flatnonzero((log["kind"] == BREAK) & (log["cause"] == REST))[0]
    wrong = with_column(log, "end_s", lambda end_s: end_s.__setitem__(row, end_s[row] - 5.0))
    assert "comes back with a fatigue of" in said(rests, wrong, plan)


def test_a_rest_that_nobody_takes_is_found(ran):
    log, plan = ran
    assert "nobody does" in said(rests, log, replace(plan, human=replace(plan.human, rest=None)))


class Levels:
    def __init__(self, above, until):
        self.above, self.until = above, until
