import pytest
from human_plans import LINE, planned

from opsim.engine.floor import run_plan
from opsim.kpi import KPIS
from opsim.kpi.workers import learned
from tests.opsim.kpi.made_logs import found, made, work

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
