"""The whole study on a small line: what adds up, what is refused, what is deterministic."""

import numpy as np
import pytest

from opsim.scenario.schema.studies import Labour
from opsim.study.labour.budget import figure_budget
from opsim.study.labour.study import labour_summary
from tests.opsim.study.labour.made import FEWER, found

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
