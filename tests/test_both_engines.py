"""``pytest --both-engines``: what the second engine does otherwise is a failure, what it does not run is counted."""

from collections import Counter

import pytest
from both_engines import DIFFERENT, EQUAL, REFUSED, doubled
from plans import line, plan

from opsim.engine.floor.run import run_plan

LINE = plan(line(2, 1, horizon="600 s", warm_up="0 s"))


def refuse(*_):
    raise ZeroDivisionError("of one engine")


def run_by(reference, other, words=()):
    """What is counted, and what comes of it."""
    runs = Counter()
    try:
        answer = doubled(reference, other, lambda _: words, runs)(LINE, 0)
    except Exception as error:
        answer = error
    return dict(runs), answer


def test_equal_logs_are_those_of_the_reference():
    counted, log = run_by(run_plan, run_plan)
    assert counted == {EQUAL: 1} and len(log) > 100


@pytest.mark.parametrize("other", [lambda plan, _: run_plan(plan, 1), refuse])
def test_another_log_or_none_is_a_failure(other):
    counted, answer = run_by(run_plan, other)
    assert counted == {DIFFERENT: 1}
    assert isinstance(answer, AssertionError) and "the engines differ" in str(answer)


def test_what_only_the_second_runs_is_a_failure():
    assert run_by(refuse, run_plan)[0] == {DIFFERENT: 1}


def test_what_both_refuse_alike_is_refused_as_before():
    counted, answer = run_by(refuse, refuse)
    assert counted == {EQUAL: 1} and isinstance(answer, ZeroDivisionError)


@pytest.mark.parametrize(
    "words", ["the rule 'mine' of opsim.dispatch is a plug-in in Python", "the human effect mine.Sleepy"]
)
def test_python_of_others_that_is_not_run_is_named(words):
    counted, log = run_by(run_plan, refuse, [words])
    assert counted == {REFUSED + words: 1} and len(log) > 100


def test_what_is_ours_and_is_not_run_is_a_failure():
    counted, answer = run_by(run_plan, run_plan, ["the rule 'mine' of opsim.dispatch is a plug-in in Python", "belts"])
    assert isinstance(answer, AssertionError) and "does not run what is ours: belts" in str(answer)
    assert counted[REFUSED + "belts"] == 1
