"""Who works in which replication."""

import numpy as np
import pytest
from plans import CELL, plan

from opsim.engine.floor import run_plan
from opsim.ergonomics.redraw import drawn_again, pieces_in_window
from opsim.plan import Plan


def staffed(how):
    return plan(CELL.replace("seed: 5", f"seed: 5, staffing: {how}"))


def test_the_same_people_work_in_every_replication_unless_they_are_redrawn():
    assert [staffed("fixed").workforce_of(r) for r in range(3)] == [0, 0, 0]
    assert [staffed("redrawn").workforce_of(r) for r in range(3)] == [0, 1, 2]


@pytest.mark.parametrize("how", ["fixed", "redrawn"])
def test_engine_and_exposure_ask_the_plan_who_works(how, monkeypatch):
    p = staffed(how)
    as_ever = run_plan(p, 1)
    monkeypatch.setattr(Plan, "workforce_of", lambda _plan, _replication: 7)
    log = run_plan(p, 1)
    assert not np.array_equal(log["end_s"], as_ever["end_s"])
    for block, pieces in drawn_again(pieces_in_window(log, p), 1, p):
        whole = np.flatnonzero((pieces.progress_from == 0) & (pieces.progress_to == 1))
        rating = {r for r in p.workers[pieces.worker[0]].rating if r}
        for row in whole:
            assert _rated(block.duration_s[pieces.k[row] % 64], rating, pieces.seconds[row])


def _rated(duration_s, ratings, seconds):
    return any(abs(duration_s / rating - seconds) < 1e-5 for rating in ratings)
