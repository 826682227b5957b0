"""What RULA, REBA and OWAS with intervals cost: about a third of a microsecond a posture (target: 1.5)."""

import numpy as np
from bench.cpu import best_s

from opsim.ergonomics.angles import COLUMNS
from opsim.ergonomics.scores.scoring import NOTHING_OPEN, bounds_of, score

N, MOST_US = 50_000, 1.5


def test_three_scores_with_intervals_cost_at_most_one_and_a_half_microseconds_a_posture():
    measures = np.random.default_rng(0).normal(0, 40, (N, len(COLUMNS))).astype(np.float32)
    known, unknown = best_s(lambda: score(measures, NOTHING_OPEN), lambda: score(measures, bounds_of()))
    print(f"\nall said {known / N * 1e6:.2f} us, nothing said {unknown / N * 1e6:.2f} us a posture")
    found = score(measures, NOTHING_OPEN)
    assert np.array_equal(found.rula[:, 0], found.rula[:, 1]) and set(np.unique(found.rula)) <= set(range(1, 8))
    assert max(known, unknown) / N * 1e6 < MOST_US
