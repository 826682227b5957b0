"""How often work was broken off, and what became of it."""

import plans
import pytest
from human_plans import LINE, planned
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.kpi import KPIS, figures
from opsim.kpi.catalogue import CATALOGUE
from opsim.kpi.catalogue import KPIS as KPIS_of_fatigue
from opsim.log import SETUP
from opsim.subjects.human.figures import learned
from tests.opsim.kpi.made_logs import found, made, row, work
from tests.opsim.laws.test_laws import PROGRESS_FLOOR as FLOOR
from tests.opsim.laws.test_laws import piece

LEARNING = "human: {learning: {model: wright, rate: 0.8}}"


def test_what_was_learned_by_hand():
    """Ana's first two, at 1 and 0.8, ben's first: mean (1 + 0.8 + 1) / 3; ana's last is her second."""
    plan = planned(LINE, LEARNING)
    rows = [work(0, 60, 0, 0, worker=0, k=0), work(60, 90, 0, 1, worker=0, k=1)]
    rows += [work(60, 80, 1, 0, worker=1, task=1, k=0)]
    values = {(f.kpi, f.subject, f.part): f.value for f in learned(_numbered(made(rows, plan)), plan)}
    assert values["learned_share", "", ""] == pytest.approx(2.8 / 3)
    assert values["learned_share", "ana", ""] == pytest.approx(0.9)
    assert values["learned_share", "ana", "cut"] == pytest.approx(0.8)
    assert values["experience", "ana", "cut"] == 2.0 and values["experience", "ben", "drill"] == 1.0


def _numbered(log):
    log.columns["performance_id"][:] = range(len(log))
    return log


def test_a_new_worker_has_the_share_of_the_first_and_learns():
    plan = planned(LINE, LEARNING.replace("0.8", "0.9"))
    values = found(run_plan(plan), plan)
    assert values["learned_share", "cy", "paint"] < values["learned_share", "cy", ""] < 1.0


def test_without_learning_there_is_nothing_to_tell():
    plan = planned(LINE)
    assert not {"learned_share", "experience"} & {kpi for kpi, _, _ in found(run_plan(plan), plan)}


def test_the_figures_can_be_asked_for():
    assert {"learned_share", "experience"} <= set(KPIS)


ONE = """
opsim: 1
name: one
run: {horizon: 1200 s, warm_up: 300 s, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 150 s}}
stations: {s: {at: a, tasks: [make], buffer: 1}}
products: {part: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}}}
human:
  fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min, slows: 0}
  rest: {above: 0.4, until: 0.2}
"""
MINE = ("fatigue_mean", "fatigue_most", "rest_taken_min_per_h")


def fatigue_found(log, plan):
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan)}


def test_figures_of_a_hand_worked_quarter_of_an_hour():
    # work to 450 s, rest of 305.800 s to 755.800 s (test_human_rest.py), work to 1055.800 s, rest until 1200 s; the
    # window begins at 300 s. Levels: 0.292893 at 300 s, 0.405396 at 450; 0.2, 0.327282, 0.434314 after two more
    # mean: 0.5 (0.292893 + 0.405396) 150 + 0.5 (0.2 + 0.327282) 150 + 0.5 (0.327282 + 0.434314) 150, over 450: 0.331195
    # rest: 305.800 + 144.200 = 450 s of 900 s, 30 minutes an hour
    values = fatigue_found(*plans.ran(ONE))
    for name in ("", "w"):
        assert values["fatigue_mean", name, ""] == pytest.approx(0.331195, abs=2e-6)
        assert values["fatigue_most", name, ""] == pytest.approx(0.434315, abs=2e-6)
        assert values["rest_taken_min_per_h", name, ""] == pytest.approx(30.0, abs=1e-3)
    assert values["worker_states", "w", "rest"] == pytest.approx(0.5, abs=1e-5)
    assert sum(value for (kpi, _, _), value in values.items() if kpi == "worker_states") == pytest.approx(1.0)


def test_muscles_have_a_figure_for_each_joint():
    text = ONE.replace("make: {fixed: 150 s}", "make: {emulator: work/stoop, load: 10 kg}").replace(
        "layout:", "libraries: {work: libraries/bench_work.npz}\nlayout:"
    )
    values = fatigue_found(*plans.ran(text[: text.index("human:")] + "human: {fatigue: {model: 3cc_r}}\n"))
    joints = {
        part: value for (kpi, who, part), value in values.items() if kpi == "fatigue_most" and who == "w" and part
    }
    assert max(joints.values()) == values["fatigue_most", "w", ""] > min(joints.values())
    assert not any(kpi == "rest_taken_min_per_h" for kpi, _, _ in values)


def test_figures_are_there_only_where_people_tire():
    plan = planned(LINE)
    assert not set(MINE) & {kpi for kpi, _, _ in fatigue_found(run_plan(plan), plan)}
    assert set(MINE) <= set(KPIS_of_fatigue) and set(MINE) <= set(CATALOGUE)


HOUR = FLOOR.replace("horizon: 100 s", "horizon: 2 h, warm_up: 1 h")


def counts(*rows, text=HOUR):
    p = plan(text)
    values = found(made(rows, p), p)
    return {(of, part): v for (kpi, of, part), v in values.items() if kpi == "interruptions_per_h" and v}


def test_pieces_are_counted_by_what_became_of_the_rest_where_they_ended_in_the_window():
    resumed = [piece(4000, 4004, 0, 0.4), piece(4050, 4056, 0.4, 1)]
    handed = [work(5000, 5004, 1, job=1, worker=0, k=5, task=1, progress=(0, 0.4))]
    handed += [work(5004, 5010, 1, job=1, worker=1, k=6, task=1, progress=(0.4, 1))]
    early = [work(100, 104, 0, job=2, worker=0, k=7, progress=(0, 0.4))]
    assert counts(*resumed, *handed, *early) == {
        ("", ""): 2,
        ("", "resumed"): 1,
        ("a", "resumed"): 1,
        ("", "handed_over"): 1,
        ("b", "handed_over"): 1,
    }


def test_what_the_horizon_cuts_off_is_not_broken_off_and_set_ups_are_no_work():
    assert counts(work(7196, 7200, 0, worker=0, progress=(0, 0.4))) == {}
    assert counts(row(SETUP, 4000, 4004, worker=0, station=0, job=0, task=0, k=0, progress=(0, 0.4))) == {}
