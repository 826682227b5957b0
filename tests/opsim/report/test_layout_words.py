"""What a layout study says of what is better, worse, or the same: from made numbers."""

from types import SimpleNamespace as Made

import numpy as np

from opsim.kpi.catalogue import read_asked
from opsim.report.studies.layout_sentences import answer
from opsim.study.compare import paired
from opsim.study.intervals import t_interval
from opsim.study.layout.evaluate import BEST, EACH, EXPOSURE, SHARE, WALKED, Against
from opsim.study.layout.study import gains, losses

RNG = np.random.default_rng(3)
NOW, LUCK = np.linspace(98, 102, 10), RNG.standard_normal(10)


def against(then, now=NOW):
    difference, p, _ = paired(then, now)
    return Against(t_interval(now), t_interval(then), difference, p, p)


MORE, LESS, HARDLY, PERHAPS = (
    against(NOW * 1.05 + 0.1 * LUCK),
    against(NOW * 0.95 + 0.1 * LUCK),
    against(NOW + 0.5 * (LUCK - LUCK.mean())),
    against(NOW + 20 * (LUCK - LUCK.mean())),
)


def said(walked, best, figure="throughput_per_h", clash="", alike=("proposal_1",), **more):
    asked = Made(best=read_asked(figure), exposure=None, floor=Made(at={"saw": "a", "drill": "b"}), replications=10)
    asked.clash = clash
    at = {"saw": "b", "drill": "a"}
    taken = Made(at=at, moved={}, added=(), proposed=True, name="proposal_1")
    asked.exposure = read_asked("rula_from_5_min_per_h") if more else None
    fresh = {WALKED: walked, BEST: best, EACH: walked, SHARE: walked, **more}
    better, worse = gains(fresh, asked.best), losses(fresh, asked.best)
    found = Made(asked=asked, taken=taken, candidates=(taken,), fresh=fresh, compared={}, alike=alike)
    found.gains, found.losses = better, worse
    return answer(found)


def test_a_gain_is_recommended():
    words = said(LESS, MORE)
    assert words[0].startswith("Swap drill and saw: 5.0") and "more parts an hour" in words[0]
    assert not any(" but " in sentence or "Leave" in sentence for sentence in words)


def test_what_is_clearly_worse_in_both_is_not_recommended():
    words = said(MORE, LESS)
    assert words[0].startswith("Leave it as it is") and words[1].startswith("That was to swap drill and saw: ")


def test_more_walking_for_nothing_is_not_recommended():
    words = said(MORE, HARDLY)
    assert words[0].startswith("Leave it as it is") and not any("saved" in sentence for sentence in words)


def test_a_gain_that_costs_something_says_but_and_the_gain_first():
    few_walked, little_out = said(LESS, LESS)[0], said(MORE, MORE)[0]
    assert few_walked.index("less walking") < few_walked.index(", but ") < few_walked.index("less parts an hour")
    assert little_out.index("more parts an hour") < little_out.index(", but ") < little_out.index("more walking")


def test_of_a_figure_of_which_less_is_better_less_is_the_gain():
    assert "but" not in said(LESS, LESS, "less work_in_progress")[0]
    assert said(MORE, MORE, "less work_in_progress")[0].startswith("Leave it as it is")


def test_only_walking_is_saved_where_the_output_is_surely_the_same():
    assert "the output stays the same within 2 %" in said(LESS, HARDLY)[-1]
    assert not any("What is saved" in sentence for sentence in said(LESS, PERHAPS))


def test_metres_of_a_shift_are_those_of_all_people_together():
    assert "in 8 hours by all together" in said(LESS, MORE)[0]


def test_what_is_not_measured_is_not_told_as_no_difference():
    words = said(LESS, MORE, **{EXPOSURE: against(NOW * np.nan, NOW * np.nan)})[0]
    assert "not measured, because no work that is done here has a known posture" in words
    assert "has most of it: no clear difference" not in words


def test_layouts_that_no_test_tells_apart_are_told_by_name():
    words = said(LESS, MORE, alike=("now", "proposal_1", "proposal_2"))
    assert any(
        one.startswith("No test tells the present layout and proposal_2 from proposal_1 by throughput") for one in words
    )


def test_changes_that_clash_are_said_to_be_left_out():
    assert (
        "left out, since they clash: a and b would stand at c."
        in said(LESS, MORE, clash="a and b would stand at c")[-1]
    )
