import json

import pytest

from opsim.human.catalogue import EFFECTS, catalogue
from tests.opsim.cli.calls import opsim


def test_every_effect_is_listed_with_its_source():
    code, shown, _ = opsim("effects")
    assert code == 0
    assert all(one.model in shown and one.source[:20] in shown for one in catalogue())


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_parameter_of_an_effect_is_listed(effect):
    code, shown, _ = opsim("effects", effect)
    assert code == 0
    names = [one.name.removesuffix("_s") for found in catalogue() if found.effect == effect for one in found.parameters]
    assert all(name in shown for name in names)


def test_machines_get_defaults_and_neutral_values():
    code, shown, _ = opsim("effects", "circadian", "--json")
    (one,) = json.loads(shown)["effects"]
    amplitude = {"name": "amplitude", "unit": "", "default": 0.05, "neutral": 0.0}
    assert code == 0 and one["model"] == "cosine" and amplitude.items() <= one["parameters"][0].items()


def test_an_unknown_effect_is_a_mistake_with_the_nearest_word():
    assert opsim("effects", "fatige" if "fatigue" in EFFECTS else "learnin")[0] == 2
    code, _, complaint = opsim("effects", "learnin")
    assert code == 2 and complaint == "no effect 'learnin'; did you mean 'learning'?\n"


def test_keys_of_all_effects_are_told_below_the_table():
    _, shown, _ = opsim("effects")
    assert "acts_on: posture" in shown and "absence: 0.05" in shown
