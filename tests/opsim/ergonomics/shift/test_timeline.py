from types import SimpleNamespace

import numpy as np
import pytest

from opsim.ergonomics.shift.ledger import Minutes, timeline
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.ergonomics.shift.test_booking import frames
from tests.opsim.kpi.made_logs import made, work


def of(*rula):
    return SimpleNamespace(rula=np.array(rula, np.int8))


def stretch(worker, start_s, seconds):
    nothing = [0] * len(seconds)
    return frames(worker, start_s, seconds, nothing, nothing, nothing, nothing, np.zeros((len(seconds), 2)))


def test_frames_are_shared_out_to_the_minutes_they_lie_in():
    minutes = Minutes(made_plan(warm_up_s=60.0, horizon_s=300.0))
    minutes.add(stretch(0, [70, 110, 150], [40, 40, 90]), of((3, 5), (6, 7), (0, 0)))
    minutes.add(stretch(1, [60], [60]), of((5, 5)))
    found = minutes.close()
    assert found.edge_s.tolist() == [60, 120, 180, 240, 300]
    assert found.known_s.tolist() == [[50, 30, 0, 0], [60, 0, 0, 0]]
    assert found.unknown_s.tolist() == [[0, 30, 60, 0], [0, 0, 0, 0]]
    assert found.rula_low[0, :2].tolist() == [(3 * 40 + 6 * 10) / 50, 6] and np.isnan(found.rula_low[0, 2:]).all()
    assert found.rula_high[0, 0] == (5 * 40 + 7 * 10) / 50
    assert found.from_5_s[0].tolist() == [10, 30, 0, 0] and found.from_5_at_most_s[0].tolist() == [50, 30, 0, 0]


def test_all_minutes_together_are_the_time_at_work():
    plan = made_plan(horizon_s=1000.0, warm_up_s=30.0)
    rows = [work(20 + 9.5 * k, 29 + 9.5 * k, 0, worker=0, k=k, task=BEND) for k in range(40)]
    rows.append(work(500, 700, 0, worker=1, k=0, task=COUNT))
    found = timeline(made(rows, plan), plan)
    assert found.known_s.sum() == pytest.approx(8.5 + 38 * 9)
    assert found.unknown_s[1].sum() == pytest.approx(200) and found.known_s.max() <= 60 + 1e-9
    assert found.unknown_s[1][8:11].tolist() == pytest.approx([40, 60, 60])
