from functools import cache

import numpy as np
import pytest

from emulator.fitting.registration import registered
from emulator.fitting.settings import FitSettings
from emulator.model.emulator import SCHEME, SCHEMES, MotionEmulator
from emulator.synthetic.tasks import make


@cache
def fitted():
    motions, _ = make("pick", 3, 4, seed=2)
    return MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8)


def test_auto_gives_one_of_the_schemes_and_says_why():
    report = fitted().report
    assert report.scheme in SCHEMES
    assert report.methods["scheme"].startswith(report.scheme + " (best of 3, next ")
    assert "repetitions held out" in report.methods["scheme"] and "people held out" in report.methods["scheme"]
    assert ("scheme, chosen", report.methods["scheme"]) in report.rows()


def test_auto_is_the_chosen_scheme_and_nothing_else():
    motions, _ = make("pick", 3, 4, seed=2)
    named = MotionEmulator.fit(motions, scheme=fitted().report.scheme, n_times=21, n_knots=8)
    drawn = [model.sample(5, np.random.default_rng(0)) for model in (fitted(), named)]
    assert np.array_equal(drawn[0].scores, drawn[1].scores)


def test_one_person_is_judged_by_his_repetitions_alone():
    motions, _ = make("pick", 1, 6, seed=2)
    said = MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8).report.methods["scheme"]
    assert "repetitions held out" in said and "people held out" not in said


def test_where_nothing_can_be_held_out_auto_is_refused():
    motions, _ = make("pick", 3, 1, seed=2)
    with pytest.raises(ValueError, match="nothing can be held out of so few repetitions; name a scheme"):
        MotionEmulator.fit(motions, scheme="auto", n_times=21, n_knots=8)


def test_a_subset_is_the_same_repetitions():
    motions, _ = make("pick", 2, 3, seed=2)
    made = registered(motions, FitSettings(SCHEME, None, 21, 8, 0.0, 0, ""), None)
    part = made.subset(np.array([True, False, True, False, True, False]))
    assert [m.name for m in part.moving.motions] == [made.moving.motions[i].name for i in (0, 2, 4)]
    assert np.array_equal(part.warps, made.warps[::2]) and len(part.holds) == 3
