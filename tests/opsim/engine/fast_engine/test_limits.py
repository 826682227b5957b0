"""Plans that are too large for the ids of streams are refused in words, not run with the luck of others."""

from types import SimpleNamespace

import pytest
from made_machine import as_floor, empty_floor, entered
from plans import CELL, plan, queue
from stand_in_engine import install_rule

from opsim.engine.choice import NotFast, able_to
from opsim.engine.fast_engine import run, run_plan, unsupported
from opsim.engine.fast_engine.random_numbers import MOST_RANKS, stream_id, stream_of
from opsim.engine.fast_engine.run import refuse_too_many


def of(**more):
    none = dict.fromkeys(("workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns"), ())
    return SimpleNamespace(**{**none, **{what: range(n) for what, n in more.items()}})


@pytest.mark.parametrize("what", ["workers", "tasks", "stations", "operations", "sources", "stops", "breakdowns"])
def test_more_than_there_are_numbers_for_is_refused(what):
    refuse_too_many(of(**{what: MOST_RANKS}))
    with pytest.raises(NotImplementedError, match=f"65,537 {what}, where it tells 65,536 apart"):
        refuse_too_many(of(**{what: MOST_RANKS + 1}))


def test_the_fast_engine_says_so_and_auto_takes_the_other(monkeypatch):
    made = plan(CELL)
    monkeypatch.setattr(run, "MOST_RANKS", 2)
    assert unsupported(made) == ["3 workers, where it tells 2 apart"]
    assert able_to("auto", made).engine == "simpy"
    with pytest.raises(NotFast, match="3 workers"):
        able_to("fast", made)


def test_ids_of_different_ranks_differ_up_to_the_last():
    last, ids = MOST_RANKS - 1, stream_id.py_func
    ends = [(one, two, three) for one in (0, last) for two in (0, last) for three in (0, last)]
    assert len({ids(purpose, *ranks) for purpose in (1, 13) for ranks in ends}) == 16


@entered
def stream_at(floor_at, visit):
    return stream_of(as_floor(floor_at), 1, 2, 3, visit).id


def test_a_visit_beyond_is_an_error_and_not_another_stream():
    arena, floor = empty_floor()
    arena.freeze()
    assert stream_at(floor.address, MOST_RANKS - 1) & 0xFFFF == MOST_RANKS - 1
    with pytest.raises(OverflowError, match="65,536 visits"):
        stream_at(floor.address, MOST_RANKS)


def test_a_plan_with_a_plug_in_rule_is_refused_in_the_words_of_unsupported(tmp_path, monkeypatch):
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    made = plan(queue(horizon="1 h").replace("oldest_job", "mine"))
    with pytest.raises(NotImplementedError) as refused:
        run_plan(made)
    assert [str(refused.value)] == unsupported(made)
