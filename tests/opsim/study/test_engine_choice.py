"""What the fast engine does not run is said with its place in the file."""

import pytest
from stand_in_engine import install_rule, stand_in

from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario import read_scenarios
from opsim.study import engine_choice
from opsim.study.engine_choice import engine_of, engines_of
from tests.opsim.cli.calls import LINE, line

PEOPLE = """
workers: {ana: {skills: {}}}
allocation: {rule: mine}
overrides: {sorted: {flow.dispatch: yours}}
scenarios: {base: [], other: [sorted]}
"""


NONE, TEN = ({"base": n, "other": n} for n in (0, 10))


@pytest.fixture
def variants(tmp_path, monkeypatch):
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    install_rule(tmp_path, monkeypatch, "opsim.sequencing", "yours")
    file = line(tmp_path, LINE + PEOPLE.replace("skills: {}", "skills: {saw: 1.0}"))
    return {name: (one, compile_plan(one)) for name, one in read_scenarios(file).items()}


def test_every_place_of_all_variants_is_said_at_once_and_each_once(variants, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    with pytest.raises(ScenarioError) as refused:
        engines_of("fast", variants, NONE)
    told = {(one.line, one.path, one.message.partition(": ")[2]) for one in refused.value.problems}
    assert told == {
        (17, "allocation.rule", "the rule 'mine' of opsim.dispatch is a plug-in in Python"),
        (18, "flow.dispatch", "the rule 'yours' of opsim.sequencing is a plug-in in Python"),
        (0, "", "belts"),
    }
    assert len(refused.value.problems) == 3 and "--engine auto" in str(refused.value)


def test_auto_takes_an_engine_for_each_variant(variants, monkeypatch):
    stand_in(monkeypatch)
    found = engines_of("auto", variants, TEN)
    assert {name: one.engine for name, one in found.items()} == {"base": "simpy", "other": "simpy"}
    assert "'mine'" in found["base"].why and found["other"].why.endswith("and 1 more")


@pytest.fixture
def shops(tmp_path, monkeypatch):
    """Two variants of which SimPy would take 3 s an hour."""
    stand_in(monkeypatch)
    monkeypatch.setattr(engine_choice, "simpy_s", lambda plan: plan.horizon_s / 1200)
    monkeypatch.setattr(engine_choice, "cores", lambda: 4)
    more = "\noverrides: {long: {run.horizon: 10 h}, short: {run.horizon: 1 h}}\nscenarios: {a: [long], b: [short]}\n"
    return {name: (one, compile_plan(one)) for name, one in read_scenarios(line(tmp_path, LINE + more)).items()}


@pytest.mark.parametrize(
    ("runs", "processes", "waited_s"),
    [
        ({"a": 1, "b": 1}, None, 33),  # one replication is done on one core
        ({"a": 1, "b": 2}, None, 33),
        ({"a": 8, "b": 4}, None, 63),
        ({"a": 8, "b": 4}, 2, 126),
        ({"a": 0, "b": 8}, None, 6),
    ],
)
def test_auto_counts_the_seconds_of_all_variants_on_the_cores_that_there_are(shops, runs, processes, waited_s):
    found = engines_of("auto", shops, runs, processes=processes)
    assert {one.engine for one in found.values()} == {"fast" if waited_s > 20 else "simpy"}
    takes = "SimPy would take" if waited_s > 20 else "it takes"
    rounded = round(waited_s, -1) if waited_s > 100 else waited_s
    assert all(f"{takes} about {rounded} s for 2 variants," in one.why for one in found.values())


def test_a_choice_stays_what_it_is(variants, monkeypatch):
    stand_in(monkeypatch)
    loaded, plan = variants["base"]
    chosen = engine_of("auto", loaded, plan)
    assert engine_of(chosen, loaded, plan) is chosen


def test_a_file_that_has_gone_leaves_what_is_wrong_without_a_place(variants, monkeypatch):
    stand_in(monkeypatch)
    loaded, plan = variants["base"]
    loaded.file.unlink()
    with pytest.raises(ScenarioError) as refused:
        engine_of("fast", loaded, plan)
    assert [one.line for one in refused.value.problems] == [0]
