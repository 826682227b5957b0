"""The whole study on a small line: what adds up, what is refused, what is deterministic.

What buys the loss back: the best of many steps is held to more than a single one.

What may buy the loss back: who is added, who learns what.

Hiring luck of a known line; ``python -m study_evidence.staffing`` does the same with 800 workforces.
"""

import numpy as np
import pytest
from study_evidence.staffing import EXPECTED, split

from opsim.plan import compile_plan
from opsim.scenario.schema.studies import Labour
from opsim.study.labour.budget import figure_budget
from opsim.study.labour.interventions import curve_of, more_skills, more_workers
from opsim.study.labour.study import labour_summary
from tests.opsim.study.labour.made import FEWER, LINE, found, loaded, varied

PEOPLE_ALIKE = FEWER.replace(", between_share: 0.5", "")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return found(tmp_path_factory.mktemp("labour"), alone=True, target="20 a day", buy_back={"most_workers": 1})


def test_parts_and_interaction_add_up_to_the_whole(made):
    for one in made.budget[:2]:
        total = sum(part.mean for part in one.parts.values()) + one.interaction.mean
        assert total == pytest.approx(one.whole.mean, abs=1e-9)
        assert one.full.mean + one.whole.mean == pytest.approx(one.all_off.mean)


def test_a_figure_that_goes_with_its_source_is_told_as_not_known(made):
    fatigue = next(one for one in made.budget if one.key[0] == "fatigue_mean")
    assert np.isnan(fatigue.parts["fatigue"].mean) and np.isfinite(fatigue.parts["learning"].mean)


def test_with_everything_off_no_day_is_unlike_another(made):
    assert made.budget[0].all_off.half_width == 0


def test_the_day_is_the_scheduled_hours_of_the_run(made):
    assert made.day.asked.hours == pytest.approx(0.4)
    rate = made.parts["throughput_per_h", "", "", "1/h"].mean
    assert made.day.values.mean() == pytest.approx(0.4 * rate)
    assert made.day.chance.estimate == np.mean(made.day.values >= 20)


def test_every_way_to_buy_back_is_told_step_by_step(made):
    assert {curve.name: [step.count for step in curve.steps] for curve in made.bought.curves} == {
        "more like ana": [1],
        "more like cem": [1],
        "skills more, in a chain": [1, 2, 3],
    }
    step = made.bought.curves[0].steps[0]
    assert step.gained.mean - made.bought.loss.mean == pytest.approx(step.beyond.mean)


def test_the_same_study_is_the_same_twice_and_another_design_is_another(tmp_path, made):
    said = {"budget": "off", "buy_back": None}
    crossed, again, nested = (found(tmp_path, design=d, **said) for d in ("crossed", "crossed", "nested"))
    assert str(labour_summary(crossed)) == str(labour_summary(again))
    assert crossed.parts != nested.parts
    assert crossed.budget == () and crossed.bought is None
    key = ("throughput_per_h", "", "", "1/h")
    assert crossed.parts[key].mean == made.parts[key].mean


def test_the_budget_adds_up_where_parts_are_estimated_on_their_own():
    """A made floor: effects a, b, and c of both together; each estimated from people and days of its own."""
    rng = np.random.default_rng(12)

    def luck():
        return rng.normal(size=(40, 1)) * 3 + rng.normal(size=(1, 4)) + rng.normal(size=(40, 4)) * 0.5

    budgets = []
    for _ in range(3):
        full = 50 + luck()
        a_off, b_off, own = full + 4, full + 2, rng.normal(size=(40, 4)) * 0.4
        budgets.append(figure_budget(("f", "", "", "1"), full, {"a": a_off, "b": b_off + own}, full + 9 + 2 * own))
    first, second, third = budgets
    apart = first.parts["a"].mean + second.parts["b"].mean + third.interaction.mean - first.whole.mean
    wide = sum(of.half_width**2 for of in (second.parts["b"], third.interaction, first.whole)) ** 0.5
    assert abs(apart) <= wide
    assert third.interaction.low <= 3 <= third.interaction.high
    assert third.interaction.low > 0


@pytest.mark.parametrize(("text", "words"), [
    (PEOPLE_ALIKE, "between_share: 0.4"),
    (FEWER.replace("seed: 5}", "seed: 5, variability: within_only}"), "switched off already"),
    (FEWER.partition("workers:")[0].replace("0.5}", "0.5, automatic: true}"), "no workers"),
])  # fmt: skip
def test_what_has_nothing_to_split_is_refused_with_the_way_out(tmp_path, text, words):
    with pytest.raises(ValueError, match=words):
        found(tmp_path, text)


@pytest.mark.parametrize(("said", "words"), [
    ({"target": "walked_m/zoe <= 10"}, "walked_m/ana"),
    ({"figures": ["rula_mean/zoe"]}, "rula_mean/zoe"),
    ({"buy_back": {"like": ["zoe"]}}, "no worker 'zoe'"),
])  # fmt: skip
def test_what_is_not_there_is_named_with_what_is(tmp_path, said, words):
    with pytest.raises(ValueError, match=words):
        found(tmp_path, **{"workforces": 2, "budget": "off", "buy_back": None, **said})


def test_the_block_refuses_what_cannot_be_split():
    for said, words in (
        ({"workforces": 1}, "at least 2 workforces"),
        ({"replications": 1}, "cannot be told apart"),
        ({"target": "throughput >= 6"}, "did you mean"),
        ({"design": "mixed"}, "crossed"),
    ):
        with pytest.raises(ValueError) as error:
            Labour.model_validate(said)
        of = error.value.errors()[0]
        assert words in f"{of['msg']} {of.get('ctx', {})}"


RNG = np.random.default_rng(21)
FULL = 60 + RNG.normal(size=(20, 4))
EQUAL = FULL + 5


def one_step(beyond, tried):
    return curve_of("a", "workers", [(1, EQUAL + beyond)], FULL, EQUAL, "nested", tried).steps[0]


def test_a_single_step_has_its_own_interval():
    step = one_step(RNG.normal(size=(20, 4)), 1)
    assert step.sure is not None and (step.sure.low, step.sure.high) == pytest.approx(
        (step.beyond.low, step.beyond.high)
    )


def test_a_step_is_sure_by_itself_and_not_as_one_of_many():
    noise = RNG.normal(size=(20, 4))
    by = noise - noise.mean()
    beyond = by + 1.2 * one_step(by, 1).beyond.half_width
    assert one_step(beyond, 1).surely and one_step(beyond, 20).enough and not one_step(beyond, 20).surely


def test_of_twenty_steps_that_are_just_the_loss_one_is_rarely_sure():
    """Each by itself would be sure in one of 40: four times in ten some one of twenty is."""
    rng, wrong = np.random.default_rng(22), 0
    for _ in range(100):
        steps = [(k, EQUAL + rng.normal(size=(20, 4))) for k in range(1, 21)]
        wrong += any(step.surely for step in curve_of("a", "workers", steps, FULL, EQUAL, "nested").steps)
    assert wrong <= 9  # expected 2.5 of 100


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


@pytest.mark.slow
@pytest.mark.parametrize("variant", ["half"])
def test_hiring_luck_is_that_of_the_recursion_within_a_quarter_and_apart_from_run_noise(variant):
    parts = split(variant, workforces=80, replications=2, horizon="400 s")  # error of an SD of 80: 8 %
    assert parts["staffing"].sd == pytest.approx(EXPECTED[variant], rel=0.25)
    assert parts["staffing"].low_sd <= EXPECTED[variant] <= parts["staffing"].high_sd
    assert parts["run"].sd < 0.35 * parts["staffing"].sd


@pytest.mark.slow
def test_where_people_are_alike_there_is_no_hiring_luck():
    parts = split("none", workforces=4, replications=2, horizon="300 s")
    assert parts["staffing"].estimate == pytest.approx(0, abs=1e-12)
    assert parts["day"].sd > 0
