import numpy as np
import pytest

from opsim.study.long_run import welch


def naive_welch(replications, window):
    """Law's definition, word by word: (2w + 1) values about i, fewer near the start."""
    mean = [sum(values) / len(values) for values in zip(*replications)]
    smooth = []
    for i in range(1, len(mean) - window + 1):
        reach = window if i > window else i - 1
        about = [mean[i - 1 + s] for s in range(-reach, reach + 1)]
        smooth.append(sum(about) / len(about))
    return smooth


def test_smoothing_by_hand():
    """Means 1, 2, 6, 3, 4, 8; one value to either side: 1, (1+2+6)/3, (2+6+3)/3, (6+3+4)/3, (3+4+8)/3."""
    assert welch([[0, 2, 5, 3, 4, 7], [2, 2, 7, 3, 4, 9]], 1) == pytest.approx([1, 3, 11 / 3, 13 / 3, 5])


@pytest.mark.parametrize("window", [0, 1, 7, 25])
def test_it_is_the_naive_curve(window):
    made = np.random.default_rng(window).normal(size=(3, 100)).cumsum(axis=1)
    assert welch(made, window) == pytest.approx(naive_welch(made.tolist(), window))


def test_a_straight_line_stays_itself():
    assert welch(np.arange(40.0), 5) == pytest.approx(np.arange(35.0))


def test_a_window_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="expected 0 to 10, a quarter of 40"):
        welch(np.zeros(40), 11)
