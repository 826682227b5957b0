"""Changes laid over a variant: paths that lead nowhere, and what the order of changes decides (nothing)."""

from itertools import permutations
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.problems import ScenarioError
from opsim.scenario.paths import nearest_path
from opsim.scenario.read import scenarios_in
from opsim.scenario.study_checks import Varied

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


HERE = Path(__file__).parent
VARIED_GOOD = Varied.read(HERE / "good.yaml")
FULL = Varied.read(HERE / "everything.yaml")


def said(changes, varied=VARIED_GOOD, **more):
    with pytest.raises(ScenarioError) as caught:
        varied.with_changes(changes, **more)
    return caught.value.problems


@pytest.mark.parametrize(
    ("path", "found", "hint"),
    [
        ("layout.plces.bench", "no 'plces' in layout", "layout.places.bench"),
        ("stations.pak.buffer", "no 'pak' among the stations", "stations.pack.buffer"),
        ("stations.pack.bufer", "no 'bufer' in stations.pack", "stations.pack.buffer"),
        ("workers.ana.wlk", "no 'wlk' in workers.ana", "workers.ana.walk"),
        ("workers.ben.skils.pack", "no 'skils' in workers.ben", "workers.ben.skills.pack"),
        ("Workers.ana.walk", "no 'Workers' in a scenario", "workers.ana.walk"),
        ("workers.walk", "no 'walk' among the workers", "workers.ana.walk"),
        ("pack.buffer", "no 'pack' in a scenario", "stations.pack.buffer"),
        ("horizon", "no 'horizon' in a scenario", "run.horizon"),
        ("run.time.horizon", "no 'time' in run", "run.horizon"),
        ("workers..walk", "a part of this path is empty", "workers.ana.walk"),
        ("workers. ana.walk", "no ' ana' among the workers", "workers.ana.walk"),
        ("tasks.lift.fixd", "no 'fixd' in tasks.lift", "tasks.lift.fixed"),
        ("human.learning.rat", "no 'rat' in human.learning", "human.learning.rate"),
        ("defaults.worker.walk", "no 'worker' among the defaults", "defaults.workers.walk"),
    ],
)
def test_a_path_that_leads_nowhere_is_answered_with_the_nearest_full_path(path, found, hint):
    (problem,) = said({path: 1})
    assert (problem.file, problem.line, problem.column) == ("changes", 1, 1)
    assert (problem.path, problem.message, problem.hint) == (path, found, f"did you mean {hint}?")


@pytest.mark.parametrize(
    ("path", "found", "hint"),
    [
        ("layout.places.bench[0]", "'bench[0]' cannot be a part of a path", "a list is replaced whole: give layout."),
        ("layout.places.bench.0", "layout.places.bench is a list; its parts", "give the whole list at layout.places."),
        ("release.kind.x", "release.kind is 'poisson'; nothing lies inside it", "give a new value at release.kind"),
        ("run.posture.x", "nothing lies inside run.posture", "give a value at run.posture"),
        ("workers.ana.patrol.x", "workers.ana.patrol is a list", "give the whole list at workers.ana.patrol"),
        ("tools.gun.n", "no 'gun' among the tools", "to add one, write tools.gun: {...}"),
        ("opsim", "no 'opsim' in a scenario", "known: allocation, cards, "),
        ("nosuch.a", "no 'nosuch' in a scenario", "known: allocation, cards, "),
        ("studies.sweep.x", "no 'x' in studies.sweep", "known: "),
        ("", "a part of this path is empty", "a path is written like workers.ana.walk"),
    ],
)
def test_a_path_with_nothing_near_says_the_way_out(path, found, hint):
    (problem,) = said({path: 1})
    assert problem.message.startswith(found)
    assert problem.hint.startswith(hint)


def test_all_wrong_paths_and_all_wrong_values_are_said_at_once_and_where_they_come_from():
    changes = {"stations.pak.buffer": 1, "run.horizon": "4 hours", "workers.ana.wlk": "1 m/s", "run.seed": "x"}
    problems = said(changes, origin="--vary")
    assert {problem.file for problem in problems} == {"--vary"}
    assert [problem.path for problem in problems] == list(changes)


def test_a_slip_in_a_new_entry_s_name_is_no_new_entry():
    assert said({"stations.pak": 4})[0].hint == "did you mean stations.pack?"
    assert "adds a place 'benc' that nothing uses" in said({"layout.places.benc": ["1 m", "1 m"]})[0].message


def test_entries_are_added_whole():
    workers = VARIED_GOOD.with_changes({"workers.eva": {"like": "ana", "walk": "1 m/s"}}).scenario.workers
    assert workers["eva"].walk_m_per_s == 1.0
    assert VARIED_GOOD.with_changes({"workers.ben.skills.pack": 0.9}).scenario.workers["ben"].skills == {"pack": 0.9}


def test_the_order_of_changes_decides_nothing():
    changes = {
        "workers.eva.walk": "1 m/s",
        "workers.eva": {"like": "ben"},
        "workers.ben.skills.pack": 0.9,
        "workers.ben": {"like": "ana"},
        "workers.ana.skills": {"pack": 1.3},
    }
    found = {repr(VARIED_GOOD.with_changes(dict(order)).scenario) for order in permutations(changes.items())}
    assert len(found) == 1
    workers = VARIED_GOOD.with_changes(changes).scenario.workers
    assert [workers[name].skills["pack"] for name in ("ana", "ben", "eva")] == [1.3, 0.9, 0.9]
    assert workers["eva"].walk_m_per_s == 1.0


def test_who_is_like_another_copies_what_changes_make_of_him():
    """Of two deep changes the copied one comes first, whatever their names are."""
    changes = {"workers.ben.skills.pack2": 0.5, "workers.ana.skills.unload": 0.7}
    for order in (changes, dict(reversed(changes.items()))):
        skills = FULL.with_changes(order).scenario.workers["ben"].skills
        assert (skills["pack2"], skills["unload"]) == (0.5, 0.7)


words = st.sampled_from(["workers", "ana", "walk", "stations", "pack", "buffer", "run", "layout", "like", "x", ""])
parts = st.lists(st.one_of(words, st.text(max_size=6)), min_size=1, max_size=5)
values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8)),
    lambda inside: st.one_of(st.lists(inside, max_size=3), st.dictionaries(st.text(max_size=5), inside, max_size=3)),
    max_leaves=4,
)


@settings(max_examples=60, deadline=None)
@given(st.dictionaries(parts.map(".".join), values, max_size=3))
def test_changes_of_any_kind_give_a_scenario_or_a_list_of_mistakes(changes):
    try:
        VARIED_GOOD.with_changes(changes)
    except ScenarioError as error:
        assert error.problems
        assert str(error)


@given(parts)
@settings(max_examples=40, deadline=None)
def test_the_nearest_path_is_a_path(asked):
    near = nearest_path(VARIED_GOOD.tree, asked)
    if near is not None:
        assert nearest_path(VARIED_GOOD.tree, near.split(".")) == near
