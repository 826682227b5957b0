import numpy as np
import pytest

from opsim.fitting import between_share
from opsim.tasks import Lognormal


def test_known_answer():
    """Two workers, two times each: logs 0, 2 and 4, 6: MSW 2, MSB 16, between (16 - 2) / 2 = 7."""
    assert between_share(np.exp([0.0, 2.0, 4.0, 6.0]), ["a", "a", "b", "b"]) == pytest.approx(7 / 9)


def test_workers_who_are_alike_have_no_share():
    assert between_share(np.exp([0.0, 2.0, 0.0, 2.0]), ["a", "a", "b", "b"]) == 0.0


def test_the_share_that_was_put_in_is_found():
    model, rng = Lognormal(20.0, 0.4, 0.4), np.random.default_rng(2)
    n_of = rng.integers(5, 40, 300)
    times = [model.sample(n, rng, worker=model.draw_worker(rng)).duration_s for n in n_of]
    names = [f"w{worker}" for worker, n in enumerate(n_of) for _ in range(n)]
    assert between_share(np.concatenate(times), names) == pytest.approx(0.4, abs=0.1)


@pytest.mark.parametrize("names", [["a"] * 4, ["a", "b", "c", "d"]])
def test_what_cannot_be_told_is_said(names):
    with pytest.raises(ValueError, match="two workers at least"):
        between_share(np.arange(1.0, 5.0), names)
