import numpy as np
import pytest

from emulator.judge import PaperScheme, distances, energy_u
from tests.emulator.judge.made import sequences


def test_as_many_components_as_there_are_give_the_sequences_back():
    y = sequences(9, 20, 4)
    assert np.abs(PaperScheme.fit(y, 8, 8).reconstruct(y) - y).max() < 1e-9


def test_draws_have_the_law_of_what_a_gaussian_can_say():
    y = sequences(200, 12, 3, 0.1)
    again = PaperScheme.fit(y[:100], 6, 8).sample(300, np.random.default_rng(0))
    assert again.shape == (300, 12, 3, 3)
    assert np.allclose(np.linalg.norm(again, axis=-1), 1)
    apart = energy_u(distances(again, y[100:]), distances(again), distances(y[100:]))
    assert apart < 0.02 * distances(y).mean()


def test_more_numbers_than_the_sequences_span_are_refused():
    with pytest.raises(ValueError, match="d2: found 30"):
        PaperScheme.fit(sequences(9, 40, 20), 4, 30)
