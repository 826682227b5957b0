from dataclasses import dataclass
from math import inf, nan

import pytest

from opsim.human.catalogue import Checked, neutral_of, parameter, parameters_of
from opsim.human.learning import DeJong


@dataclass(frozen=True, slots=True)
class Made(Checked):
    share: float = parameter(0.5, "a share", neutral=0.0, at_least=0.0, at_most=1.0)
    rate: float = parameter(1.0, "above nothing", neutral=1.0, above=0.0, endless=True)
    by: str = parameter("even", "a word", words=("even", "odd"))


def test_all_mistakes_are_told_at_once():
    with pytest.raises(ValueError) as told:
        Made(share=2.0, rate=0.0, by="evn")
    assert str(told.value) == (
        "share: found 2.0, expected a number at least 0, at most 1; rate: found 0.0, expected a number above 0; "
        "by: found 'evn', expected even or odd"
    )


@pytest.mark.parametrize("value", [nan, -inf, True, "0.5", None])
def test_what_is_no_number_is_refused(value):
    with pytest.raises(ValueError, match="share: found"):
        Made(share=value)


def test_only_what_may_be_endless_is():
    assert Made(rate=inf).rate == inf
    with pytest.raises(ValueError, match="share: found inf"):
        Made(share=inf)


def test_neutral_values_are_put_in_place_of_the_defaults():
    assert neutral_of(Made) == Made(share=0.0, rate=1.0, by="even")


def test_parameters_come_in_the_order_of_the_fields():
    assert [one.name for one in parameters_of(DeJong)] == ["rate", "incompressible", "measured_at"]


def test_a_model_of_learning_refuses_a_rate_that_no_integral_bears():
    with pytest.raises(ValueError, match=r"rate: found 0\.5, expected a number above 0\.5, at most 1"):
        DeJong(rate=0.5)
