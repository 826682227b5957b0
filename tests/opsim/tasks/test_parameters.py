"""Parameters that are no times are refused where a model is made."""

import math

import pytest

from opsim.tasks import Erlang, Exponential, Fixed, Geometric, Hyperexponential, Lognormal, Uniform


@pytest.mark.parametrize(
    "make",
    [
        lambda: Fixed(-5.0),
        lambda: Fixed(0.0),
        lambda: Exponential(math.nan),
        lambda: Exponential(math.inf),
        lambda: Lognormal(20.0, -0.2),
        lambda: Lognormal(-1.0, 0.2),
        lambda: Lognormal(20.0, 0.2, 1.5),
        lambda: Hyperexponential(0.0, 1.5),
        lambda: Erlang(5.0, 0),
        lambda: Geometric(5.0, 6.0),
        lambda: Uniform(-1.0, 2.0),
    ],
)
def test_an_impossible_parameter_is_refused(make):
    with pytest.raises(ValueError, match="must be"):
        make()


def test_a_text_is_no_time():
    with pytest.raises(TypeError, match="duration_s must be a time in seconds above 0, found '5'"):
        Fixed("5")
