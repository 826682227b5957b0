from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.judge import distances
from emulator.judge.paper import IS_TVF, OURS, PWI, SIEM, VAR
from emulator.schemes import Scheme
from tests.emulator.judge.paper.classes import lifts

SPAN = slice(180, 211)


def test_a_class_stands_on_301_points_where_its_emulator_stands():
    c = lifts()
    assert c.task == "lift" and c.aligned.shape == (15, 301, c.motions.skeleton.n_bones, 3)
    tangent = c.emulator.flatten.forward(c.aligned).mean(axis=0).ravel()
    assert np.abs(tangent - c.emulator.posture.mean).max() < 1e-3


@pytest.mark.parametrize("name", [IS_TVF, SIEM, PWI, OURS])
def test_draws_lie_about_the_recordings_and_are_new(name):
    drawn, part = lifts().draw(name, 15, SPAN), lifts().aligned[:, SPAN]
    assert drawn.shape == part.shape and np.allclose(np.linalg.norm(drawn, axis=-1), 1)
    nearest = distances(drawn, part).min(axis=1)
    assert nearest.min() > 0 and nearest.max() < distances(part).max()


def test_a_part_of_ours_is_drawn_from_the_model_of_the_whole():
    """The paper fits each part anew; ours is one model, so its part has the whole's mean."""
    drawn = lifts().draw(OURS, 400, SPAN)
    course = lifts().aligned[:, SPAN].mean(axis=0)
    assert np.abs(drawn.mean(axis=0) - course).max() < 0.05


def test_the_seed_and_the_name_decide_the_draws():
    c = lifts()
    one = c.draw(SIEM, 3, SPAN, (4, 4))
    assert np.array_equal(one, c.draw(SIEM, 3, SPAN, (4, 4)))
    assert not np.allclose(one, replace(c, seed=2).draw(SIEM, 3, SPAN, (4, 4)))
    assert not np.allclose(one, c.draw(IS_TVF, 3, SPAN, (4, 4)))


def test_functions_of_time_are_cut_to_what_the_recordings_span():
    rng = np.random.default_rng(0)
    rough = replace(lifts(), aligned=sphere.normalise(lifts().aligned + 1e-3 * rng.normal(size=lifts().aligned.shape)))
    assert np.array_equal(rough.draw(SIEM, 2, SPAN, (4, 14)), rough.draw(SIEM, 2, SPAN, (4, 99)))


def test_an_exploding_var_is_drawn_all_the_same():
    fitted = Scheme.fit(lifts().aligned, VAR, seed=1)
    assert fitted.model.modulus > 1
    with pytest.raises(ValueError, match="explode"):
        fitted.sample(2, np.random.default_rng(0))
    drawn = lifts().draw(VAR, 2)
    assert drawn.shape == (2, *lifts().aligned.shape[1:]) and np.isfinite(drawn).all()
