from types import SimpleNamespace

from emulator.covariates.body import RANGES
from emulator.people.new_people import BODY_KEYS as EMULATOR_KEYS
from opsim.external_worker import library_model
from opsim.plan.workers import Body
from opsim.task_model import BODY_KEYS, BODY_RANGES, keys_read
from opsim.tasks import Fixed, Lognormal, switched


def test_a_scenario_and_an_emulator_take_the_same_bodies():
    assert {name: (low, high) for name, (low, high, _) in RANGES.items()} == BODY_RANGES
    assert EMULATOR_KEYS == BODY_KEYS


def test_what_is_known_of_a_body_is_said_by_the_names_that_models_read():
    assert Body().said == ()
    assert Body(height_m=1.7, sex="f").said == ("height_m", "sex")
    assert Body(1.7, 60.0, 41.0, "f", 1.1, "s03").said == BODY_KEYS


def test_times_read_nothing_of_a_body_and_emulators_say_what():
    assert keys_read(Fixed(1.0)) == keys_read(switched(Lognormal(1.0, 0.2, 0.5), "none")) == ()
    squat = library_model("public_movements/deep_squat")
    assert {"height_m", "pace", "person"} <= set(keys_read(squat)) <= set(BODY_KEYS)
    assert keys_read(switched(squat, "within_only")) == keys_read(squat)


def test_a_model_that_does_not_say_may_read_anything():
    assert keys_read(SimpleNamespace()) == BODY_KEYS
