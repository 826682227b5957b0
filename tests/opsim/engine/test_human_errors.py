import numpy as np
import pytest
from checked_floors import differ
from human_plans import LINE, planned, shipped

from opsim.engine.floor import run_plan
from opsim.laws import audit
from opsim.log import BAD, FINISH, REWORK

TIRED = "fatigue: {model: lffrm, tires_half_in: 1 h, slows: 0}"
INSPECTED = LINE.replace(
    "c: {at: three, tasks: [paint], buffer: 2}",
    "c: {at: three, tasks: [paint], buffer: 2, inspect: {finds: 0.5, then: {rework: c}}}",
)


def with_errors(share, text=LINE):
    return planned(text, f"human: {{{TIRED}, errors: {{at_full_fatigue: {share}}}}}")


def bad(log):
    return {int(job) for job in log["job"][(log["kind"] == FINISH) & (log["cause"] == BAD)]}


def test_more_errors_spoil_more_jobs_and_all_that_fewer_spoil():
    """Fatigue slows nobody here, so all else is the same; a defect is the same number below a larger chance."""
    none, some, many = (bad(run_plan(with_errors(share))) for share in (0, 0.1, 0.4))
    assert none == set() and some < many and some


def test_the_share_of_defects_is_what_the_levels_of_those_who_worked_make_of_it():
    """Hours at half an hour's half-time leave everybody near exhausted: three operations, (1 - 0.1)^3 = 0.729 good."""
    plan = planned(
        LINE.replace("horizon: 4 h", "horizon: 40 h"),
        "human: {fatigue: {model: lffrm, tires_half_in: 5 min, recovers_half_in: 1000 h, slows: 0}, "
        "errors: {at_full_fatigue: 0.1}}",
    )
    log = run_plan(plan)
    late = (log["kind"] == FINISH) & (log["start_s"] > 2 * 3600)
    n, share = np.count_nonzero(late), np.mean(log["cause"][late] == BAD)
    assert abs(share - 0.271) < 4 * np.sqrt(0.271 * 0.729 / n)


def test_defects_of_the_tired_are_found_and_reworked():
    plan = with_errors(0.4, INSPECTED)
    log = run_plan(plan)
    audit(log, plan)
    assert np.count_nonzero(log["kind"] == REWORK) > 5


@pytest.mark.parametrize(("name", "hours"), [("solder_rework", 2.0), ("work_sharing", 2.0), ("cherry_picking", 1.0)])
def test_no_errors_at_full_fatigue_change_no_bit_of_a_log(name, hours):
    plan = shipped(name, hours, f"human: {{{TIRED}, errors: {{at_full_fatigue: 0}}}}")
    assert plan.quality and plan.human.errors is not None
    assert differ(run_plan(plan), run_plan(shipped(name, hours))) == []


def test_the_quality_of_a_learner_and_fatigue_go_together():
    """0.8 of ben's work is good when he is fresh: with errors never more of it, and the same jobs are bad at least."""
    text = LINE.replace("{b: 1.0}", "{b: {pace: 1.0, quality: 0.8}}")
    plain, tired = (bad(run_plan(with_errors(share, text))) for share in (0, 0.3))
    assert plain < tired


def test_machines_that_work_alone_do_not_err():
    plan = planned(
        LINE.replace("drill: {dist", "drill: {automatic: true, dist").replace("  ben: {skills: {b: 1.0}}\n", ""),
        f"human: {{{TIRED}, errors: {{at_full_fatigue: 0.4}}}}",
    )
    assert [plan.stations[one.station].name for one in plan.quality] == ["a", "c"]
