import numpy as np
import pytest

from opsim.scenario.schema.sweep import Sweep
from opsim.study.sweep.factors import MOST_POINTS, points_of

VARY = {"release.every": {"from": "40 s", "to": "60 s"}, "stations.saw.buffer": [1, 2, 4]}


def points(**said):
    return points_of(Sweep.model_validate({"vary": VARY, **said}), 7)


def test_a_grid_takes_every_combination_of_levels_and_values():
    found = points(design="grid", levels=2)
    assert found.values == (("40 s", 1), ("40 s", 2), ("40 s", 4), ("60 s", 1), ("60 s", 2), ("60 s", 4))
    assert found.points(None)[3].changes == {"release.every": "60 s", "stations.saw.buffer": 1}


def test_the_design_follows_from_what_is_varied():
    assert points(levels=2).design == "grid" and points().design == "latin_hypercube"
    assert points(vary=None, points=[{"release.every": "9 s"}]).design == "list"


def test_ten_points_a_factor_are_taken_where_nobody_says_how_many():
    assert len(points().values) == 20 and len(points(design="sobol").values) == 32


def test_the_same_seed_gives_the_same_points():
    block = Sweep.model_validate({"vary": VARY, "points": 9})
    assert points_of(block, 7).values == points_of(block, 7).values != points_of(block, 8).values


def test_one_at_a_time_leaves_the_other_factors_alone():
    found = points(design="one_at_a_time")
    changes = [dict(point.changes) for point in found.points(None)]
    assert changes[:3] == [{}, {"release.every": "40 s"}, {"release.every": "60 s"}] and len(changes) == 6


def test_numbers_that_are_no_power_of_two_are_said():
    assert "64 are" in points(design="sobol", points=50).words[0] and not points(design="sobol", points=64).words


def test_points_that_a_design_does_not_use_are_said():
    assert points(design="one_at_a_time", points=50).warned == (
        "The points of the design one_at_a_time follow from its factors: 'points: 50' is not used.",
    )


def test_a_latin_hypercube_gives_each_value_of_a_list_the_same_part():
    found = points(points=30)
    counts = np.unique([row[1] for row in found.values], return_counts=True)[1]
    assert counts.tolist() == [10, 10, 10] and found.numbers()[:, 0].min() >= 40


def test_too_many_points_are_refused():
    with pytest.raises(ValueError, match=f"at most {MOST_POINTS:,} are run"):
        points(vary={f"a.b{i}": list(range(1, 11)) for i in range(6)})
