import numpy as np
import pytest

from opsim.kpi import figures
from opsim.kpi.catalogue import EXPOSURE, KPIS, POSTURE, USUAL, headline, needs_postures
from tests.opsim.ergonomics.made_work import BEND, COUNT, Bending, made_plan
from tests.opsim.kpi.made_logs import made, work

HOUR_S = 3600.0


def figures_of(rows, plan):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(made(rows, plan), plan, POSTURE) if f.kpi in POSTURE}


@pytest.fixture(scope="module")
def by_hand():
    """In two hours ana bends 20 times for 9 s and counts for 60 s, ben bends once, half as long."""
    plan = made_plan(horizon_s=3 * HOUR_S, warm_up_s=HOUR_S)
    start = HOUR_S + 100 * np.arange(20)
    rows = [work(s, s + 9, 0, worker=0, k=k, task=BEND) for k, s in enumerate(start)]
    rows += [work(9000, 9060, 0, worker=0, k=0, task=COUNT), work(9000, 9004.5, 0, worker=1, k=0, task=BEND)]
    return figures_of(rows, plan)


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("trunk_beyond_60_min_per_h", "ana", "", 20 * 3 / 60 / 2),
        ("trunk_beyond_20_min_per_h", "ana", "", 20 * 7 / 60 / 2),
        ("trunk_beyond_60_min_per_h", "ben", "", 1.5 / 60 / 2),
        ("trunk_beyond_60_min_per_h", "", "", 61.5 / 60 / 4),
        ("trunk_flexion_mean_deg", "ana", "", 45),
        ("trunk_flexion_mean_deg", "", "", 45),
        ("trunk_flexion_p95_deg", "ben", "", 85.5),
        ("trunk_flexion_p95_deg", "", "", 85.5),
        ("trunk_flexion_share", "ana", "below_20", 40 / 7200),
        ("trunk_flexion_share", "ana", "from_20_to_60", 80 / 7200),
        ("trunk_flexion_share", "ana", "beyond_60", 60 / 7200),
        ("trunk_flexion_share", "ana", "unmeasured", 60 / 7200),
        ("trunk_flexion_share", "ana", "not_at_work", 1 - 240 / 7200),
        ("posture_measured_share", "ana", "", 180 / 240),
        ("posture_measured_share", "ben", "", 1),
        ("posture_measured_share", "", "", 184.5 / 244.5),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected, rel=0.005)


def test_shares_of_the_window_sum_to_one(by_hand):
    for subject in ("", "ana", "ben"):
        shares = [value for (kpi, of, _), value in by_hand.items() if (kpi, of) == ("trunk_flexion_share", subject)]
        assert len(shares) == 5 and sum(shares) == pytest.approx(1, abs=1e-12)


def test_work_that_nobody_measured_is_nan_and_not_upright():
    found = figures_of([work(0, 60, 0, worker=0, k=0, task=COUNT)], made_plan())
    assert np.isnan(found["trunk_beyond_60_min_per_h", "ana", ""]) and np.isnan(
        found["trunk_flexion_p95_deg", "ana", ""]
    )
    assert found["posture_measured_share", "ana", ""] == 0
    assert found["trunk_flexion_share", "ana", "unmeasured"] == pytest.approx(60 / 3600)


def test_who_does_no_work_is_never_bent():
    found = figures_of([work(0, 9, 0, worker=0, k=0, task=BEND)], made_plan())
    assert found["trunk_beyond_60_min_per_h", "ben", ""] == 0
    assert np.isnan(found["trunk_flexion_mean_deg", "ben", ""]) and np.isnan(found["posture_measured_share", "ben", ""])


def test_leaning_back_is_a_flexion_below_zero():
    found = figures_of([work(0, 9, 0, worker=0, k=0, task=BEND)], made_plan(Bending((-30.0,) * 64)))
    assert found["trunk_flexion_mean_deg", "ana", ""] == pytest.approx(-15, rel=0.01)
    assert found["trunk_flexion_share", "ana", "below_20"] == pytest.approx(9 / 3600)


def test_postures_are_made_only_where_a_figure_that_needs_them_is_asked_for():
    plan = made_plan(Bending(kind=lambda *_: pytest.fail("drawn")))
    log = made([work(0, 9, 0, worker=0, k=0, task=BEND)], plan)
    others = [kpi for kpi in KPIS if kpi not in (*POSTURE, *EXPOSURE)]
    assert {figure.kpi for figure in figures(log, plan, others)} <= set(others)
    assert not needs_postures(USUAL) and needs_postures([*USUAL, "trunk_flexion_p95_deg"])


def test_how_much_was_measured_stands_beside_whatever_was_asked_for():
    assert headline(["walked_m"]) == {"walked_m"}
    assert headline(["walked_m", "trunk_flexion_mean_deg"]) == {
        "walked_m",
        "trunk_flexion_mean_deg",
        "posture_measured_share",
    }


def test_a_floor_without_workers_has_no_figures_of_posture():
    plan = made_plan()
    assert not figures_of([], made_plan(workers=())) and figures_of([], plan)
