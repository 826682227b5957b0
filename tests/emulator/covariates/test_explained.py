import numpy as np
import pytest

from emulator.covariates.model import CovariateModel
from tests.emulator.covariates.cases import NAMES


@pytest.fixture(scope="module")
def model():
    n = 12
    i = np.arange(n)
    x = np.column_stack(
        [1.5 + 0.03 * i, 50 + 3.0 * i + 5 * np.sin(2.0 * i), 30 + 10 * np.cos(1.0 * i), 1 + 0.02 * (i % 5)]
    )
    y = np.column_stack([x[:, 0] * 10 + 0.01 * np.sin(3.0 * i), np.cos(5.0 * i)])
    return CovariateModel.fit(y, x, NAMES, ["f", "m"] * 6)


def test_every_covariate_is_named_with_asked_range_and_used(model):
    said = model.explain({"height_m": 2.0, "age_years": 35, "pace": 1.0, "sex": "f"})
    height, mass, age, pace, sex = said.lines
    assert height == "height_m: asked 2, recorded 1.5 to 1.83, used 1.83 (clamped)"
    assert mass.startswith("mass_kg: unknown, recorded 50 to 84.56, used ") and mass.endswith("(expected)")
    assert age == "age_years: asked 35, recorded 20.1 to 40, used 35 (as asked)"
    assert pace == "pace: asked 1, recorded 1 to 1.08, used 1 (as asked)"
    assert sex == "sex: asked f, recorded, used f (as asked)"
    assert said.clamped == ("height_m",)


def test_a_tall_person_of_unknown_mass_is_expected_to_be_heavy(model):
    tall, short = (model.explain({"height_m": height}).uses[1].used for height in (1.8, 1.52))
    assert tall - short > 15


def test_what_the_recordings_do_not_know_is_named_and_changes_nothing(model):
    said = model.explain({"height_m": 1.6, "other": {"grip": 300}})
    assert said.unused == ("grip",)
    assert "grip: asked 300, not in the recordings: it changes nothing here" in said.lines
    assert np.array_equal(said.mean, model.predict({"height_m": 1.6}))


def test_of_what_is_taken_care_of_elsewhere_nothing_is_said_unless_the_recordings_know_it(model):
    body = {"height_m": 1.6, "pace": 1.05, "other": {"grip": 300, "reach_m": 0.7}}
    plain, silent = model.explain(body), model.explain(body, elsewhere=("height_m", "pace", "grip"))
    assert [use.name for use in plain.uses if use not in silent.uses] == ["grip"]
    assert silent.unused == ("reach_m",)
    assert "height_m: asked 1.6, recorded 1.5 to 1.83, used 1.6 (as asked)" in silent.lines
    assert np.array_equal(silent.mean, plain.mean)


def test_a_model_of_sex_alone_says_nothing_of_a_height_that_scales_the_bones():
    alone = CovariateModel.fit(np.tile([1.0, 2.0], 4)[:, None], np.zeros((8, 0)), (), ["f", "m"] * 4)
    body = {"height_m": 1.6, "sex": "f"}
    assert [use.name for use in alone.explain(body).uses] == ["sex", "height_m"]
    assert [use.name for use in alone.explain(body, elsewhere=("height_m", "pace")).uses] == ["sex"]


def test_an_unrecorded_category_is_a_mix_of_the_recorded(model):
    use = model.explain({"sex": "diverse"}).uses[-1]
    assert use.how == "expected"
    assert use.used == "50% f, 50% m"


def test_an_unknown_way_with_outsiders_is_refused(model):
    with pytest.raises(ValueError, match="outside: no 'clip'; known: clamp, refuse"):
        model.predict({}, outside="clip")


def test_the_fit_says_how_much_it_explains(model):
    said = "1 of 2 scores explained by partial least squares, 0 by sex (f, m)"
    assert model.lines[0] == f"height_m, mass_kg, age_years, pace of 12 people: {said}"
    assert model.lines[1].startswith("leave-one-person-out R^2 of the 1 explained: 0.9")
