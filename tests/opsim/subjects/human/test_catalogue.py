import subprocess
import sys
from dataclasses import FrozenInstanceError, dataclass
from math import inf, nan

import pytest

from opsim.subjects.human.catalogue import (
    EFFECTS,
    Checked,
    Parameter,
    as_written,
    catalogue,
    entry,
    made,
    models_of,
    name_written,
    neutral_of,
    parameter,
    parameters_of,
    parameters_written,
)
from opsim.subjects.human.learning import DeJong
from opsim.subjects.human.plan import HumanPlan

ENTRIES = list(catalogue())


@pytest.mark.parametrize("one", ENTRIES, ids=lambda one: f"{one.effect}_{one.model}")
def test_every_model_says_what_it_does_where_it_is_from_and_what_its_parameters_are(one):
    assert one.does and one.source and "(" in one.source, "a source has a year"
    assert one.parameters and all(parameter.meaning for parameter in one.parameters)
    defaults = one.cls()
    assert [getattr(defaults, p.name) for p in one.parameters] == [p.default for p in one.parameters]


@pytest.mark.parametrize("one", ENTRIES, ids=lambda one: f"{one.effect}_{one.model}")
def test_every_model_is_frozen(one):
    with pytest.raises(FrozenInstanceError):
        setattr(one.cls(), one.parameters[0].name, 0.5)


def test_every_effect_has_a_place_in_the_plan():
    assert set(EFFECTS) <= set(HumanPlan.__dataclass_fields__)


def test_an_effect_of_one_model_needs_no_name_for_it():
    assert entry("circadian").model == models_of("circadian")[0]
    assert made("circadian", "circadian", {"amplitude": 0.1}).amplitude == 0.1
    assert made("learning", "plateau", {"floor": 0.4}).floor == 0.4


def test_the_catalogue_imports_no_numpy():
    names = "import sys; from opsim.subjects.human.catalogue import catalogue"
    code = f"{names}; list(catalogue()); assert 'numpy' not in sys.modules"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


TIME = Parameter("pause_s", "a pause", "s", 60.0)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(31_536_000.0, "365 d"), (86_400.0, "1 d"), (14_400.0, "4 h"), (90.0, "90 s"), (5400.0, "90 min"), (inf, "never")],
)
def test_times_are_written_as_in_a_scenario(seconds, text):
    assert as_written(TIME, seconds) == text


def test_a_parameter_is_named_without_its_unit():
    assert name_written(TIME) == "pause"


def test_a_peak_is_a_time_of_the_day():
    assert parameters_written(entry("circadian")) == "amplitude 0.05, peak 16:48"


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
