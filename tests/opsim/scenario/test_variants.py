from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")


def near(*edits):
    """The variant "near" of the good scenario with its override replaced, then other edits."""
    text = GOOD
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    return scenarios_in(text.encode(), Path("line.yaml"))["near"].scenario


def with_override(override, *edits):
    return near(("layout.places.bench: [6 m, 1 m]", override), *edits)


def test_an_override_replaces_a_value():
    assert near().layout.places["bench"] == (6.0, 1.0)


def test_an_override_adds_a_worker():
    assert with_override("workers.eva: {like: ana, walk: 1 m/s}").workers["eva"].walk_m_per_s == 1.0


def test_an_override_reaches_into_a_section_that_is_not_written():
    assert with_override("run.warm_up: 0 s", (" warm_up: 30 min,", "")).run.warm_up_s == 0.0
    assert (
        with_override("allocation.rule: oldest_job", ("allocation: {rule: nearest}\n", "")).allocation.rule
        == "oldest_job"
    )


def test_an_override_of_a_part_of_what_is_copied_keeps_the_rest():
    edits = [("skills: {pack: 1.1}", "skills: {pack: 1.1, check: 1.0}")]
    edits += [("stations:\n", "stations:\n  check: {at: door, tasks: [lift]}\n")]
    ben = with_override("workers.ben.skills.pack: 0.9", *edits).workers["ben"]
    assert ben.skills == {"pack": 0.9, "check": 1.0}


def test_an_override_changes_a_part_of_a_default():
    text = GOOD.replace("layout.places.bench: [6 m, 1 m]", "defaults.workers.walk: 1 m/s").replace(
        "workers:\n", "defaults: {workers: {walk: 2 m/s}}\nworkers:\n"
    )
    loaded = scenarios_in(text.encode(), Path("line.yaml"))
    assert [loaded[name].scenario.workers["ben"].walk_m_per_s for name in ("base", "near")] == [2.0, 1.0]


def test_an_override_of_a_part_of_a_default_block_keeps_the_rest():
    edits = [("skills: {pack: 1.1}", "walk: 1 m/s"), ("stations:\n", "stations:\n  check: {at: door, tasks: [lift]}\n")]
    edits += [("workers:\n", "defaults: {workers: {skills: {pack: 1.1, check: 1.0}}}\nworkers:\n")]
    ana = with_override("workers.ana.skills.pack: 0.9", *edits).workers["ana"]
    assert ana.skills == {"pack": 0.9, "check": 1.0}


def test_who_is_like_a_worker_follows_his_overrides():
    assert with_override("workers.ana.walk: 1 m/s").workers["ben"].walk_m_per_s == 1.0


def test_later_overrides_go_over_earlier_ones():
    text = GOOD.replace("scenarios:", "  far: {layout.places.bench: [9 m, 1 m]}\nscenarios:").replace(
        "[near]", "[near, far]"
    )
    assert scenarios_in(text.encode(), Path("line.yaml"))["near"].scenario.layout.places["bench"] == (9.0, 1.0)


def test_the_base_is_untouched_by_the_variants():
    base = scenarios_in(GOOD.encode(), Path("line.yaml"))["base"]
    assert base.scenario.layout.places["bench"] == (4.0, 1.0)
    assert "overrides" not in base.resolved and "scenarios" not in base.resolved


def test_a_file_without_scenarios_is_its_base():
    text = GOOD.replace("scenarios: {base: [], near: [near]}\n", "")
    assert list(scenarios_in(text.encode(), Path("line.yaml"))) == ["base"]


def test_chosen_variants_come_in_the_order_asked_for():
    assert list(scenarios_in(GOOD.encode(), Path("line.yaml"), ["near", "base"])) == ["near", "base"]
    with pytest.raises(ScenarioError, match=r"no scenario 'nera' in this file\n  did you mean 'near'\?"):
        scenarios_in(GOOD.encode(), Path("line.yaml"), ["nera"])


@pytest.mark.parametrize(
    ("override", "said"),
    [
        ("nosuch.a: 1", "no 'nosuch' in a scenario"),
        ("opsim: 1", "no 'opsim' in a scenario"),
        ("'layout.places.bench[0]': 1 m", "a list is replaced whole"),
        ("layout.places.bench.x: 1 m", "layout.places.bench is a list"),
        ("run.seed.x: 1", "run.seed is 7; nothing lies inside it"),
        ("workers..walk: 1 m/s", "a part of this path is empty"),
        ("workers.an.walk: 1 m/s", "did you mean workers.ana.walk?"),
        ("run.sed: 8", "did you mean run.seed?"),
        ("stations.pak: {at: bench, tasks: [lift]}", "adds a station 'pak' that nothing uses"),
    ],
)
def test_a_path_that_leads_nowhere_is_said_at_its_line(override, said):
    with pytest.raises(ScenarioError) as caught:
        with_override(override)
    assert said in str(caught.value)
    assert {problem.line for problem in caught.value.problems} == {20}


def test_an_override_that_no_scenario_uses_is_checked_too():
    text = GOOD.replace("near: [near]", "near: []").replace("layout.places", "layuot.places")
    with pytest.raises(ScenarioError, match=r"did you mean layout\.places\.bench\?"):
        scenarios_in(text.encode(), Path("line.yaml"))


def test_a_variant_s_name_cannot_lead_out_of_the_results_folder():
    text = GOOD.replace("near: [near]", "../../near: [near]")
    with pytest.raises(ScenarioError, match=r"'../../near' cannot be a name"):
        scenarios_in(text.encode(), Path("line.yaml"))


def test_changes_from_elsewhere_go_over_every_variant_and_into_what_is_resolved():
    loaded = scenarios_in(GOOD.encode(), Path("line.yaml"), changes={"run.horizon": "4 h", "run.seed": 9})
    for variant in loaded.values():
        assert (variant.scenario.run.horizon_s, variant.scenario.run.seed) == (14400.0, 9)
        assert variant.resolved["run"]["horizon"] == "4 h"


def test_a_wrong_change_is_said_once_and_as_a_change():
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(GOOD.encode(), Path("line.yaml"), changes={"run.horizon": "4 hours"})
    assert str(caught.value) == (
        "changes:1:14: run.horizon: unknown unit 'hours'\n     1 | run.horizon: 4 hours\n"
        "       |              ^ write '4 h'\n1 problem in changes"
    )
