import pytest

from opsim.cli.compare import check_asked, frontier_texts
from opsim.plan import compile_plan
from opsim.plan.workers import NO_EFFECTS
from opsim.scenario.read import scenarios_in
from tests.human_plans import LINE

HUMAN = """
human: {fatigue: {model: lffrm}}
overrides: {off: {human: null}}
scenarios: {base: [], plain: [off]}
"""


@pytest.fixture(scope="module")
def variants(tmp_path_factory):
    return scenarios_in((LINE + HUMAN).encode(), tmp_path_factory.mktemp("asked") / "line.yaml")


def refused(variants, *words):
    with pytest.raises(ValueError) as error:
        check_asked(variants, *words)
    return str(error.value).splitlines()


def test_all_that_is_wrong_is_said_at_once(variants):
    said = refused(variants, "bass", ["walked"], "queue_length/d,worker_states/ana/wait")
    assert said[0].startswith("no variant 'bass' to compare with; did you mean 'base'")
    assert said[1].startswith("no figure 'walked'") and said[2].startswith("queue_length/d: no station 'd'")
    assert said[3].startswith("worker_states/ana/wait: which way is better depends on who asks") and len(said) == 4


def test_what_can_be_had_is_not_refused(variants):
    check_asked(variants, "base", ["walked_m"], "throughput_per_h,fatigue_mean")
    check_asked(variants, "base", [], "throughput_per_h,queue_length/a")
    check_asked(variants, "base", [], None)


def test_figures_of_postures_that_no_run_makes_and_one_figure_twice_are_refused(variants):
    assert "'outputs' list it" in refused(variants, "base", ["rula_mean"], None)[0]
    assert "two different figures" in refused(variants, "base", [], "walked_m/ana, walked_m/ana")[0]
    assert frontier_texts("a , b") == ["a", "b"] and frontier_texts(None) is None


def test_human_null_in_an_override_switches_all_effects_off(variants):
    assert compile_plan(variants["plain"]).human is NO_EFFECTS
    assert compile_plan(variants["base"]).human.fatigue is not None
