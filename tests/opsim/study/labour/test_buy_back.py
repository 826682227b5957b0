"""What buys the loss back: the best of many steps is held to more than a single one."""

import numpy as np
import pytest

from opsim.study.labour.interventions import curve_of

RNG = np.random.default_rng(21)
FULL = 60 + RNG.normal(size=(20, 4))
EQUAL = FULL + 5


def one_step(beyond, tried):
    return curve_of("a", "workers", [(1, EQUAL + beyond)], FULL, EQUAL, "nested", tried).steps[0]


def test_a_single_step_has_its_own_interval():
    step = one_step(RNG.normal(size=(20, 4)), 1)
    assert step.sure is not None and (step.sure.low, step.sure.high) == pytest.approx(
        (step.beyond.low, step.beyond.high)
    )


def test_a_step_is_sure_by_itself_and_not_as_one_of_many():
    noise = RNG.normal(size=(20, 4))
    by = noise - noise.mean()
    beyond = by + 1.2 * one_step(by, 1).beyond.half_width
    assert one_step(beyond, 1).surely and one_step(beyond, 20).enough and not one_step(beyond, 20).surely


def test_of_twenty_steps_that_are_just_the_loss_one_is_rarely_sure():
    """Each by itself would be sure in one of 40: four times in ten some one of twenty is."""
    rng, wrong = np.random.default_rng(22), 0
    for _ in range(100):
        steps = [(k, EQUAL + rng.normal(size=(20, 4))) for k in range(1, 21)]
        wrong += any(step.surely for step in curve_of("a", "workers", steps, FULL, EQUAL, "nested").steps)
    assert wrong <= 9  # expected 2.5 of 100
