"""What the emulator says of people, where the truth about them is known."""

import numpy as np
import pytest

from emulator.model.emulator import MotionEmulator
from emulator.people.variance_components import intraclass_correlation
from emulator.synthetic import tasks as synthetic

N_SETS, TRUE_ICC = 20, 0.8


@pytest.fixture(scope="module")
def sets():
    return [synthetic.make("lift", 8, 10, seed=seed, between_share=TRUE_ICC)[0] for seed in range(N_SETS)]


@pytest.mark.slow
def test_the_true_icc_lies_in_its_interval_in_17_of_20_sets_or_more_and_the_interval_is_of_use(sets):
    found = [intraclass_correlation(np.log(motions.duration_s), motions.worker_index) for motions in sets]
    inside = sum(low < TRUE_ICC < high for _, low, high in found)
    assert inside >= 17
    assert np.median([high - low for _, low, high in found]) <= 0.5


@pytest.mark.slow
def test_the_share_between_people_that_an_emulator_learns_is_what_the_durations_tell(sets):
    """Eight people tell 0.753 of 0.8 on average (2,000 sets of plain normal numbers): a ratio of two estimates."""
    learned = [MotionEmulator.fit(motions, n_times=21, n_knots=8).between_share for motions in sets]
    told = [intraclass_correlation(np.log(motions.duration_s), motions.worker_index)[0] for motions in sets]
    assert np.abs(np.array(learned) - told).max() < 0.02
    assert np.mean(learned) == pytest.approx(0.753, abs=3 * np.std(told) / np.sqrt(N_SETS))


@pytest.mark.slow
def test_new_people_last_as_long_as_fresh_ones_of_the_truth(sets):
    """Each crew of eight is off by its own luck; pooled over 20 crews, drawn people are as the truth's (KS)."""
    from scipy.stats import ks_2samp

    drawn = []
    for seed, motions in enumerate(sets):
        model, rng = MotionEmulator.fit(motions, n_times=21, n_knots=8), np.random.default_rng(seed)
        drawn += [float(model.sample(1, rng, worker=model.draw_worker(rng)).duration_s[0]) for _ in range(20)]
    fresh = synthetic.make("lift", 400, 1, seed=99, between_share=TRUE_ICC)[0].duration_s
    assert ks_2samp(drawn, fresh).statistic < 1.63 * np.sqrt(1 / 400 + 1 / (8 * N_SETS))
