from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from opsim.ergonomics.angles import CANONICAL
from opsim.ergonomics.redraw import neck_neutral_rad, neck_neutrals_rad
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.tasks import Fixed
from tests.opsim.ergonomics.bodies import bent, moved, turn


@dataclass(frozen=True)
class Starts:
    """Performances that begin with these necks (n,) and trunks (n,), in degrees; a task model of itself."""

    neck_deg: tuple[float, ...]
    trunk_deg: tuple[float, ...]
    report: object = None
    skeleton = SimpleNamespace(names=CANONICAL)

    @property
    def duration_s(self):
        return np.ones(len(self.neck_deg))

    def positions_m(self, n_times):
        lean = [turn([0, 1, 0], neck) for neck in self.neck_deg]
        first = [moved(bent(trunk), way, "neck", ["head"]) for trunk, way in zip(self.trunk_deg, lean)]
        return np.repeat(np.array(first)[:, None], n_times, axis=1)


class Model(Starts):
    def sample(self, n, rng, *, worker=None, condition=None):
        return Starts(self.neck_deg, self.trunk_deg)


def degrees(**models):
    return {task: round(float(np.rad2deg(angle)), 9) for task, angle in neck_neutrals_rad(models).items()}


def test_the_neutral_is_the_median_of_those_that_begin_upright():
    starts = Starts((12.0, 18.0, 14.0, 60.0), (0.0, 10.0, -14.0, 40.0))
    assert np.rad2deg(neck_neutral_rad(starts)) == pytest.approx(14.0)
    assert neck_neutral_rad(Model(starts.neck_deg, starts.trunk_deg)) == neck_neutral_rad(starts)


def test_where_most_begin_bent_it_cannot_be_told():
    assert neck_neutral_rad(Starts((12.0, 18.0, 20.0), (0.0, 30.0, 40.0))) == 0.0


def test_times_without_a_body_have_none():
    assert degrees(count=Fixed(3.0)) == {"count": 0.0}


def test_tasks_of_the_same_recordings_share_the_median_of_theirs():
    one, other = SimpleNamespace(source="lab"), SimpleNamespace(source="plant")
    tasks = {"reach": Model((10.0,), (0.0,), one), "fasten": Model((30.0,), (0.0,), one)}
    tasks |= {"place": Model((14.0,), (0.0,), one), "stoop": Model((5.0,), (70.0,), one)}
    found = degrees(**tasks, lift=Model((20.0,), (0.0,), other), count=Fixed(3.0))
    assert found == {"reach": 14.0, "fasten": 14.0, "place": 14.0, "stoop": 14.0, "lift": 20.0, "count": 0.0}


def test_made_work_stands_with_the_head_it_was_made_with_every_time():
    """Key postures of made tasks that look ahead have the head 16.5 degrees forward."""
    library = load_library(shipped_folder() / "libraries" / "bench_work.npz")
    found = degrees(pick=library["pick"], reach=library["reach"])
    assert found["pick"] == found["reach"] == pytest.approx(16.5, abs=0.1)
    assert found == degrees(reach=library["reach"], pick=library["pick"])
