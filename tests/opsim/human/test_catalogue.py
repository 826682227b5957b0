import subprocess
import sys
from dataclasses import FrozenInstanceError

import pytest

from opsim.human.catalogue import EFFECTS, catalogue, entry, made, models_of
from opsim.plan.workers import HumanPlan

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
    code = (
        "import sys; from opsim.human.catalogue import catalogue; list(catalogue()); assert 'numpy' not in sys.modules"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
