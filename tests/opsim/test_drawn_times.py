import numpy as np
import pytest
from human_plans import LINE, planned, shipped

from opsim.engine.draws import Draws
from opsim.history import drawn_s


@pytest.mark.parametrize("k", [[0], [63, 64, 65], [200, 3, 3, 130], []])
def test_what_was_drawn_is_what_the_engine_draws(k):
    plan = planned(LINE.replace("cv: 0.25}", "cv: 0.25, between_share: 0.5}"))
    engine = Draws(plan, 2)
    expected = [engine.duration_s(1, 2, one) for one in k]
    assert drawn_s(plan, 2, 2, 1, np.array(k, dtype=np.int64)).tolist() == expected


@pytest.mark.slow
def test_recorded_movements_are_drawn_again_to_the_bit():
    plan = shipped("low_pallet", 1.0)
    engine, task = Draws(plan, 1), next(at for at, one in enumerate(plan.tasks) if one.handling.load_kg)
    assert drawn_s(plan, 1, 0, task, np.arange(70)).tolist() == [engine.duration_s(task, 0, k) for k in range(70)]
