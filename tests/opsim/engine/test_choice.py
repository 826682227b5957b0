"""Which engine is taken, and what is said of it; the engines themselves are not run."""

import pickle

import pytest
from plans import line, plan, queue
from stand_in_engine import install_rule, stand_in

from opsim.engine import choice
from opsim.engine.choice import NotFast, Refusal, able_to, known, make_ready, runner_of, worth
from opsim.engine.floor.run import run_plan

SHORT = line(2, 1, horizon="1 h")
LONG = queue(horizon="2000 h")


def choose(asked, made, simpy_s=0.0, **how):
    return worth(able_to(asked, made), made, simpy_s, **how)


def test_simpy_is_taken_without_a_look_at_the_fast_engine(monkeypatch):
    stand_in(monkeypatch, refuses=lambda plan: 1 / 0)
    assert choose("simpy", plan(SHORT)).engine == "simpy"


def test_fast_is_taken_where_it_runs_all_of_a_plan(monkeypatch):
    made = stand_in(monkeypatch)
    chosen = choose("fast", plan(SHORT))
    assert (chosen.engine, chosen.asked) == ("fast", "fast") and runner_of(chosen) == made.run_plan


def test_fast_is_refused_with_everything_that_it_does_not_run(monkeypatch, tmp_path):
    stand_in(monkeypatch, refuses=["belts", "kits"])
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    install_rule(tmp_path, monkeypatch, "opsim.sequencing", "yours")
    made = plan(SHORT + "\nallocation: {rule: mine}\nflow: {dispatch: yours}")
    with pytest.raises(NotFast) as refused:
        choose("fast", made)
    assert [one.words for one in refused.value.refusals] == [
        "the rule 'mine' of opsim.dispatch is a plug-in in Python",
        "the rule 'yours' of opsim.sequencing is a plug-in in Python",
        "belts",
        "kits",
    ]
    own = [("stations", station, "dispatch") for station in ("s1", "s2")]
    assert {*refused.value.refusals[1].places} == {*own, ("flow", "dispatch")}


def test_without_numbas_compiler_there_is_no_fast_engine(monkeypatch):
    monkeypatch.setattr("numba.config.DISABLE_JIT", 1)
    some = plan(LONG)
    with pytest.raises(NotFast, match="NUMBA_DISABLE_JIT"):
        choose("fast", some)
    chosen = choose("auto", some, 1000)
    assert chosen.engine == "simpy" and "numba's compiler is switched off here (NUMBA_DISABLE_JIT)" in chosen.words


def test_a_refusal_says_the_same_in_another_process():
    said = NotFast([Refusal("belts"), Refusal("kits", (("stations", "a"),))])
    there = pickle.loads(pickle.dumps(said))
    assert there.refusals == said.refusals and str(there) == str(said) and str(said).count("does not run this") == 2


def test_a_rule_that_the_engine_names_too_is_said_once(monkeypatch, tmp_path):
    stand_in(monkeypatch, refuses=["the rule 'mine' of opsim.dispatch is a plug-in in Python"])
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    with pytest.raises(NotFast) as refused:
        choose("fast", plan(SHORT + "\nallocation: {rule: mine}"))
    assert len(refused.value.refusals) == 1


def test_our_own_rules_are_no_plug_ins(monkeypatch):
    stand_in(monkeypatch)
    made = plan(SHORT + "\nallocation: {rule: oldest_job}\nflow: {dispatch: spt, routing: first_free}")
    assert choose("fast", made).engine == "fast"


def test_auto_takes_simpy_for_what_the_fast_engine_does_not_run_and_says_what(monkeypatch):
    stand_in(monkeypatch, refuses=["belts", "kits"])
    chosen = choose("auto", plan(LONG), 1000.0)
    assert chosen.engine == "simpy" and not chosen.may_pay
    assert chosen.words == "the SimPy engine, as the fast one does not run this: belts, and 1 more"


ONCE = "(about 20 s, once on this machine)"
SIMPY, MOMENT = "the SimPy engine, as it takes", "less than a second"


@pytest.mark.parametrize(
    ("simpy_s", "is_compiled", "words"),
    [
        (0.3, False, f"{SIMPY} {MOMENT}, and the fast one would first be compiled {ONCE}"),
        (0.3, True, f"{SIMPY} {MOMENT}, and the fast one would first be read from disk (about 1 s)"),
        (2.34, False, f"{SIMPY} about 2.3 s, and the fast one would first be compiled {ONCE}"),
        (2.34, True, "the fast engine, as SimPy would take about 2.3 s, and the fast one is compiled already"),
        (151.0, False, f"the fast engine, as SimPy would take about 150 s, and compiling takes {ONCE[1:-1]}"),
        (15_390.0, True, "the fast engine, as SimPy would take about 15,000 s, and the fast one is compiled already"),
    ],
)
def test_auto_takes_what_is_sooner_done_and_says_why(monkeypatch, simpy_s, is_compiled, words):
    stand_in(monkeypatch).is_compiled = is_compiled
    chosen = choose("auto", plan(SHORT), simpy_s)
    assert chosen.words == words and chosen.may_pay == (chosen.engine == "simpy")


def test_where_little_has_to_be_compiled_little_work_is_enough(monkeypatch):
    stand_in(monkeypatch).costs_s = 1.5
    assert choose("auto", plan(SHORT), 2.0).words.endswith("and compiling takes about 1.5 s, once on this machine")
    assert choose("auto", plan(SHORT), 1.4).engine == "simpy"


def test_where_nothing_can_be_kept_compiling_is_not_said_to_be_once(monkeypatch):
    made = stand_in(monkeypatch)
    made.is_kept = lambda: False
    assert "about 20 s, each time, as it can be kept nowhere" in choose("auto", plan(SHORT), 30.0).why


def test_what_is_compiled_on_other_machines_is_not_known_here(monkeypatch):
    stand_in(monkeypatch).is_compiled = True
    chosen = choose("auto", plan(SHORT), 5.0, here=False)
    assert chosen.engine == "simpy" and "compiled (about 8 s, once on each machine)" in chosen.why


def test_where_the_work_is_over_auto_is_what_can_run_the_plan(monkeypatch):
    stand_in(monkeypatch)
    assert able_to("auto", plan(SHORT)).engine == "fast"


def test_only_the_fast_engine_is_made_ready(monkeypatch):
    made, some, told = stand_in(monkeypatch), plan(SHORT), []
    make_ready(choice.REFERENCE, some)
    assert made.asked_for == [] and runner_of(choice.REFERENCE) is run_plan
    make_ready(choose("fast", some), some, lambda *steps: told.append(steps))
    assert made.asked_for == [some] and told == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_an_unknown_engine_is_answered_with_the_nearest():
    with pytest.raises(ValueError, match=r"found 'fsat', expected simpy, fast or auto; did you mean 'fast'\?"):
        known("fsat")
