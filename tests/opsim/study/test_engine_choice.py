"""What the fast engine does not run is said with its place in the file."""

import pytest
from stand_in_engine import install_rule, stand_in

from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario import read_scenarios
from opsim.study.engine_choice import engine_of, engines_of
from tests.opsim.cli.calls import LINE, line

PEOPLE = """
workers: {ana: {skills: {}}}
allocation: {rule: mine}
overrides: {sorted: {flow.dispatch: yours}}
scenarios: {base: [], other: [sorted]}
"""


@pytest.fixture
def variants(tmp_path, monkeypatch):
    install_rule(tmp_path, monkeypatch, "opsim.dispatch", "mine")
    install_rule(tmp_path, monkeypatch, "opsim.sequencing", "yours")
    file = line(tmp_path, LINE + PEOPLE.replace("skills: {}", "skills: {saw: 1.0}"))
    return {name: (one, compile_plan(one)) for name, one in read_scenarios(file).items()}


def test_every_place_of_all_variants_is_said_at_once_and_each_once(variants, monkeypatch):
    stand_in(monkeypatch, refuses=["belts"])
    with pytest.raises(ScenarioError) as refused:
        engines_of("fast", variants)
    told = {(one.line, one.path, one.message.partition(": ")[2]) for one in refused.value.problems}
    assert told == {
        (17, "allocation.rule", "the rule 'mine' of opsim.dispatch is a plug-in in Python"),
        (18, "flow.dispatch", "the rule 'yours' of opsim.sequencing is a plug-in in Python"),
        (0, "", "belts"),
    }
    assert len(refused.value.problems) == 3 and "--engine auto" in str(refused.value)


def test_auto_takes_an_engine_for_each_variant(variants, monkeypatch):
    stand_in(monkeypatch)
    found = engines_of("auto", variants, 10)
    assert {name: one.engine for name, one in found.items()} == {"base": "simpy", "other": "simpy"}
    assert "'mine'" in found["base"].why and found["other"].why.endswith("and 1 more")


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
