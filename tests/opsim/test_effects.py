import re
from pathlib import Path

import numpy as np
import pytest

from opsim.external_worker import library_model
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.streams import stream
from opsim.tasks import Fixed, Lognormal
from opsim.worker_effects import worker_effect

PUBLIC = load_library(shipped_folder() / "libraries" / "public_movements.npz")
TASKS = {"fold": Lognormal(20.0, 0.3, 0.5), "pack": Lognormal(9.0, 0.4, 0.25)}


def effects(across_tasks, n=400):
    """(n, 2) effects of n workers in two tasks."""
    return np.array(
        [[worker_effect(m, task, f"w{i}", 3, 0, None, across_tasks) for task, m in TASKS.items()] for i in range(n)]
    )


def slowness(model, effect):
    at = model.scale.block("duration").start
    return (effect.z[at] - model.workforce.between.mean[at]) / model.workforce.between.spread[at]


def test_effects_in_tasks_without_people_know_nothing_of_each_other():
    assert abs(np.corrcoef(effects("as_recorded").T)[0, 1]) < 0.15


def test_at_the_same_pace_a_worker_is_as_slow_in_every_task():
    drawn = effects("same_pace")
    spread = [np.sqrt(m.between_share * m.log_variance) for m in TASKS.values()]
    assert np.allclose(drawn[:, 0] / spread[0], drawn[:, 1] / spread[1])
    assert np.allclose(drawn.std(axis=0), spread, rtol=0.15)


def test_at_the_same_pace_emulated_tasks_and_distributions_go_together():
    squat, lunge = (worker_effect(PUBLIC[t], t, "ana", 3, 0, None, "same_pace") for t in ("deep_squat", "side_lunge"))
    fold = worker_effect(TASKS["fold"], "fold", "ana", 3, 0, None, "same_pace")
    expected = fold / np.sqrt(0.5 * TASKS["fold"].log_variance)
    assert slowness(PUBLIC["deep_squat"], squat) == pytest.approx(expected)
    assert slowness(PUBLIC["side_lunge"], lunge) == pytest.approx(expected)


def test_tasks_of_the_same_people_go_together_as_recorded():
    """Six people did both: who leans to a slow one is slow in both, by their own correlation less what is shrunk."""
    models = [PUBLIC["deep_squat"], PUBLIC["side_lunge"]]
    drawn = [[slowness(m, worker_effect(m, m.task, f"w{i}", 3, 0)) for m in models] for i in range(700)]
    at = [m.scale.block("duration").start for m in models]
    recorded = np.corrcoef(models[0].workforce.effects[:, at[0]], models[1].workforce.effects[:, at[1]])[0, 1]
    kept = 1 - models[0].workforce.between.rho
    assert recorded > 0.3
    assert np.corrcoef(np.array(drawn).T)[0, 1] == pytest.approx(kept * recorded, abs=0.08)


def test_a_task_of_which_workers_do_not_differ_has_no_effect_at_any_pace():
    assert worker_effect(Fixed(5.0), "wait", "ana", 3, 0, None, "same_pace") is None
    assert worker_effect(Lognormal(5.0, 0.3), "wait", "ana", 3, 0, None, "same_pace") is None


class LeansOn:
    """A model that tells what it is given: how far the worker leans to two people, and how slow he is."""

    knows_people = knows_slowness = True

    def draw_worker(self, rng, body, people=None, slowness=None):
        return people("s01"), people("s02"), slowness


def test_leanings_and_slowness_are_streams_of_the_workforce_and_the_same_in_all_tasks():
    for workforce in (0, 1):
        given = worker_effect(LeansOn(), "fold", "ana", 3, workforce, None, "same_pace")
        names = [("leaning", "ana", "s01", 0), ("leaning", "ana", "s02", 0), ("slowness", "ana", 0)]
        assert given == tuple(stream(3, workforce, *name).standard_normal() for name in names)
        assert given == worker_effect(LeansOn(), "pack", "ana", 3, workforce, None, "same_pace")


def test_every_stream_of_a_worker_stands_in_the_design():
    """``effect``, ``leaning`` and ``slowness``, as they stand in the code."""
    root = Path(__file__).parents[2]
    (randomness,) = [part for part in (root / "DESIGN.md").read_text("utf-8").split("\n\n") if "Used now:" in part]
    names = re.findall(
        r'stream\(seed, workforce, "(\w+)", (\w+)', (root / "opsim" / "worker_effects.py").read_text("utf-8")
    )
    assert len(names) == 3
    assert not [name for name in names if ", ".join(name) not in randomness]


def test_how_slow_a_worker_is_says_how_long_he_moves_and_not_how_long_he_pauses():
    """Stoops were made with pauses that are nobody's own: a slow worker's are those of the usual one."""
    model = library_model("bench_work/stoop")
    at, dwells = model.scale.block("duration").start, model.scale.block("dwells")
    usual, slow = (model.draw_worker(np.random.default_rng(0), slowness=s).z for s in (0.0, 2.0))
    spread = model.workforce.between.spread[at]
    assert slow[at] - usual[at] == pytest.approx(2 * spread)
    assert len(model.dwells) and np.abs(slow[dwells] - usual[dwells]).max() < 0.2 * spread
