import numpy as np
import pytest
from made_scene import scene

from opsim.viewer.pose import joints_m


@pytest.mark.parametrize(
    "name", [*(pytest.param(name, marks=pytest.mark.slow) for name in ("kitting", "two_shift_plant")), "walking_cell"]
)
def test_nobody_is_ever_outside_of_what_is_framed(name):
    shown = scene(name)
    west, south, east, north = shown.reach_m
    rng, seen = np.random.default_rng(3), 0
    for _ in range(150):
        worker, time_s = int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))
        joints = joints_m(shown, worker, time_s)
        if joints is not None:
            x, y = joints[0, :2]
            assert west - 0.6 < x < east + 0.6 and south - 0.6 < y < north + 0.6
            seen += 1
    assert seen > 20


def test_where_a_task_leads_away_from_the_bench_is_framed_too():
    """Kits are fetched three metres from the bench, where no place is."""
    south = min(y for _, _, y in scene("kitting").places)
    assert scene("kitting").reach_m[1] < south - 2.5
