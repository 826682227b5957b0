"""What may buy the loss back: who is added, who learns what."""

import pytest

from opsim.plan import compile_plan
from opsim.study.labour.interventions import more_skills, more_workers
from tests.opsim.study.labour.made import LINE, loaded, varied


def test_of_those_who_are_alike_one_is_tried(tmp_path):
    text = LINE.replace("  cem:", "  bea: {like: ana}\n  cem:")
    people, left = more_workers(loaded(tmp_path, text), 2)
    assert [one.name for one in people] == ["more like ana", "more like cem"]
    assert not left


def test_who_is_added_is_like_him_and_has_a_name_of_his_own(tmp_path):
    text = LINE.replace("  cem:", "  ana_2: {like: ana}\n  cem:")
    line = varied(tmp_path, text)
    people, _ = more_workers(line.with_changes({}), 2, ["ana"])
    workers = line.with_changes(people[0].steps[1][1]).scenario.workers
    assert [*workers] == ["ana", "ben", "ana_2", "cem", "ana_3", "ana_4"]
    assert workers["ana_4"] == workers["ana"]


def test_adding_a_name_that_nobody_has_is_answered_with_the_nearest(tmp_path):
    with pytest.raises(ValueError, match="did you mean 'ben'"):
        more_workers(loaded(tmp_path), 1, ["benn"])


def test_kinds_beyond_six_are_left_out_and_named(tmp_path):
    more = "".join(
        f"  d{n}: {{skills: {{saw: {1 + n / 100}, press: 1.0}}, zone: [saw], floater: true}}\n" for n in (1,)
    )
    shifts = "".join(f"  k{n}: {{skills: {{saw: 1.0}}, shift: s{n}}}\n" for n in range(7))
    text = LINE.replace("workers:\n", "workers:\n" + more + shifts)
    text = text.replace("shifts: {", "shifts: {" + "".join(f"s{n}: {{from: 0{n}:00, to: 14:00}}, " for n in range(7)))
    people, left = more_workers(loaded(tmp_path, text), 1)
    assert len(people) == 6
    assert "k4" in left[0] and "k5" in left[0]


def test_a_chain_gives_each_the_next_station_that_he_does_not_know_at_his_mean_pace(tmp_path):
    line = varied(tmp_path, LINE.replace("{press: 1.0}", "{press: {pace: 1.0, quality: 0.9}}"))
    base = line.with_changes({})
    (chain,) = more_skills(base, compile_plan(base), 6)
    assert chain.added == (("ana", "press"), ("ben", "press"), ("cem", "saw"))
    assert [count for count, _ in chain.steps] == [1, 2, 3]
    workers = line.with_changes(chain.steps[-1][1]).scenario.workers
    assert workers["ben"].skills == {"saw": 1.2, "press": 1.2}
    assert (workers["ben"].zone, workers["ben"].experience) == (["saw"], {"drill": 40})
    assert workers["cem"].skills["saw"] == 1.0 and workers["cem"].skills["press"].quality == 0.9


def test_a_long_chain_is_tried_at_a_few_steps_the_first_and_the_last_among_them(tmp_path):
    base = loaded(tmp_path)
    (chain,) = more_skills(base, compile_plan(base), 2)
    assert [count for count, _ in chain.steps] == [1, 3]


def test_who_knows_everything_has_nothing_to_learn(tmp_path):
    text = LINE.partition("workers:")[0] + "workforce: {n: 3, shift: early}\n"
    base = loaded(tmp_path, text)
    assert more_skills(base, compile_plan(base), 6) == []


def test_people_of_a_workforce_can_be_added_to(tmp_path):
    text = LINE.partition("workers:")[0] + "workforce: {n: 3, shift: early}\n"
    line = varied(tmp_path, text)
    people, _ = more_workers(line.with_changes({}), 1)
    workers = line.with_changes(people[0].steps[0][1]).scenario.workers
    assert [*workers] == ["w1", "w2", "w3", "w1_2"]
