"""Sources of variability: those that a scenario has on, and what switching them off leaves."""

import pytest

from opsim.plan import compile_plan
from opsim.study.labour.budget import changes_off, sources_on
from tests.opsim.study.labour.made import LINE, loaded, varied

ALL = [
    *("between workers", "within workers", "skill ratings", "pace", "learning", "forgetting", "fatigue", "absence"),
    "breaks",
]


def test_what_a_scenario_has_on_is_found(tmp_path):
    assert [one.name for one in sources_on(loaded(tmp_path))] == ALL


def test_what_is_off_already_is_no_source(tmp_path):
    text = LINE.replace("seed: 5}", "seed: 5, variability: between_only}").replace("1.2", "1.0")
    text = text.partition("human:")[0] + "outputs: [throughput_per_h]"
    assert [one.name for one in sources_on(loaded(tmp_path, text))] == ["between workers", "absence", "breaks"]


def test_switching_off_keeps_mean_times_where_it_says_so(tmp_path):
    line = varied(tmp_path)
    base = line.with_changes({})
    full = compile_plan(base)
    for name in ("between workers", "within workers"):
        plan = compile_plan(line.with_changes(changes_off(base, [name])))
        assert [t.model.mean_duration_s() for t in plan.tasks] == pytest.approx(
            [t.model.mean_duration_s() for t in full.tasks]
        )


def test_both_switches_of_people_are_one_switch(tmp_path):
    assert changes_off(loaded(tmp_path), ["between workers", "within workers"]) == {"run.variability": "none"}


def test_ratings_off_is_the_pace_of_which_the_mean_time_is_theirs(tmp_path):
    base = loaded(tmp_path)
    workers = changes_off(base, ["skill ratings"])["workers"]
    level = 2 / (1 / 1.0 + 1 / 1.2)
    assert [workers[name]["skills"]["saw"] for name in ("ana", "ben")] == pytest.approx([level, level])
    assert workers["cem"] == base.resolved["workers"]["cem"]


def test_everything_off_is_a_floor_on_which_nothing_varies(tmp_path):
    line = varied(tmp_path)
    off = line.with_changes(changes_off(line.with_changes({}), ALL))
    assert sources_on(off) == ()


@pytest.mark.parametrize("name", ALL)
def test_each_can_be_switched_off_and_is_then_gone(tmp_path, name):
    line = varied(tmp_path)
    off = line.with_changes(changes_off(line.with_changes({}), [name]))
    left = [one.name for one in sources_on(off)]
    assert name not in left
    assert set(ALL) - set(left) <= {name, "forgetting" if name == "learning" else name}


def test_people_of_a_workforce_come_to_every_shift_too(tmp_path):
    text = LINE.partition("workers:")[0] + "workforce: {n: 3, shift: early, absence: 0.2}\n"
    line = varied(tmp_path, text)
    base = line.with_changes({})
    off = line.with_changes(changes_off(base, ["absence"]))
    assert [worker.absence for worker in base.scenario.workers.values()] == [0.2] * 3
    assert [worker.absence for worker in off.scenario.workers.values()] == [0] * 3
