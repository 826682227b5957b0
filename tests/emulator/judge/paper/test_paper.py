from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.judge import distances
from emulator.judge import paper as flattening
from emulator.judge import paper as tables
from emulator.judge.paper import (
    DRAWERS,
    IS_TVF,
    LEVEL_ONE,
    N_PEOPLE,
    OURS,
    PWI,
    RECORDED,
    SIEM,
    VAR,
    dimensions,
    draws_of,
    errors_by_size,
    fields,
    first_coefficients,
    first_score,
    level_two,
    people,
    quantized,
    roughness_over_time,
    round_trip_errors,
    scaled,
    spatial_shares,
    table_1,
    table_2,
    table_3,
    tables_4_and_5,
)
from emulator.judge.paper import SPAN as PART
from emulator.judge.posture_tests import reconstruction_error
from emulator.schemes import Scheme
from emulator.schemes.flattening import ISTVF, STVF
from emulator.synthetic.tasks import make
from tests.emulator.judge.paper.classes import drawing, lifts, short, shuffled, still

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


@cache
def draws():
    return draws_of(lifts())


def test_as_many_are_drawn_as_recorded_on_the_same_part_of_the_clock():
    assert list(draws()) == [RECORDED, *DRAWERS]
    assert np.array_equal(draws()[RECORDED], lifts().aligned[:, PART])
    assert {made.shape for made in draws().values()} == {lifts().aligned[:, PART].shape}


def test_the_seed_decides_what_is_drawn_and_not_what_was_recorded():
    again, other = draws_of(lifts()), draws_of(replace(lifts(), seed=9))
    for name, made in draws().items():
        assert np.array_equal(made, again[name])
        assert np.array_equal(made, other[name]) == (name == RECORDED)


def test_people_are_seven_of_the_mean_body_with_their_root_at_zero():
    found = people(lifts(), draws())
    bones = np.mean([motion.bone_length_m for motion in lifts().motions.motions], axis=0)
    skeleton = lifts().motions.skeleton
    child = [i for i, parent in enumerate(skeleton.parents) if parent >= 0]
    for joints in found.values():
        assert joints.shape == (N_PEOPLE, skeleton.n_joints, 3) and np.all(joints[:, 0] == 0)
        length = np.linalg.norm(joints[:, child] - joints[:, [skeleton.parents[i] for i in child]], axis=-1)
        assert np.allclose(length, bones)
    first, last = draws()[SIEM][0][[0, -1]]
    again = skeleton.positions(np.stack([first, last]), bones, np.zeros((2, 3)))
    assert np.allclose(found[SIEM][[0, -1]], again)


def test_recordings_drawn_again_lie_on_the_recordings():
    points = scaled(draws_of(drawing(lifts(), lifts().aligned)))
    assert set(points) == set(DRAWERS)
    for recorded, drawn in points.values():
        assert recorded.shape == drawn.shape == (15, 2) and np.allclose(recorded, drawn, atol=1e-5)


def test_the_plane_keeps_the_distance_of_those_who_stand_still():
    """They lie far from everybody, so the first direction is the one from the recordings to them."""
    made = {RECORDED: lifts().aligned[:, PART], "still": still(lifts())[:, PART]}
    recorded, drawn = scaled(made)["still"]
    apart = np.linalg.norm(recorded.mean(axis=0) - drawn.mean(axis=0))
    between = distances(made["still"], made[RECORDED]).mean()
    assert 0.8 * between < apart < 1.1 * between
    assert np.ptp(recorded[:, 0]) + np.ptp(drawn[:, 0]) < apart


def test_points_of_the_recordings_come_first():
    recorded, drawn = scaled({RECORDED: lifts().aligned[:, PART], "few": draws()[SIEM][:4]})["few"]
    assert recorded.shape == (15, 2) and drawn.shape == (4, 2)


def test_pointwise_draws_are_rough_at_every_time_and_who_stands_still_is_not():
    found = roughness_over_time(draws() | {"still": still(lifts())[:, PART]})
    assert all(made.shape == (60,) for made in found.values())
    assert np.all(found[PWI] > 2 * found[RECORDED]) and found["still"].max() < 1e-12
    assert abs(found[OURS].mean() / found[RECORDED].mean() - 1) < 0.15


@pytest.fixture
def few(monkeypatch):
    """Fewer postures to cluster and sequences to draw than a page has."""
    monkeypatch.setattr(tables, "N_QUANTIZED", 300)
    monkeypatch.setattr(tables, "N_DRAWN", 30)


@pytest.fixture
def postures(few):
    return quantized([short()], 0)


def numbers(table, column):
    at = table.columns.index(column)
    return np.array([row[at] for row in table.rows])


def test_with_all_components_nothing_is_lost(monkeypatch):
    monkeypatch.setattr(tables, "SPAN_DIMS", ((1 - 1e-10, 9),) * 3)
    found = table_1(lifts())
    assert np.all(numbers(found, "IS-TVF") < 1e-3) and np.all(numbers(found, "SIEM") < 1e-3)


def test_fewer_components_lose_more(monkeypatch):
    usual = table_1(lifts())
    monkeypatch.setattr(tables, "SPAN_DIMS", ((2, 1), (2, 1), (2, 1)))
    least = table_1(lifts())
    for name in ("IS-TVF", "SIEM"):
        assert np.all(numbers(least, name) > 5 * numbers(usual, name))


def test_table_1_says_which_part_and_how_many_numbers():
    found = table_1(lifts())
    assert found.number == 1
    assert [row[:2] for row in found.rows] == [
        ("180 to 210", "8 x 4"),
        ("180 to 240", "10 x 5"),
        ("180 to 300", "12 x 10"),
    ]


def test_each_part_is_fitted_by_itself():
    part = lifts().aligned[:, 180:241]
    scheme = Scheme.fit(part, "SIEM/SequentialPCA/MVG", (10, 5))
    assert table_1(lifts()).rows[1][3] == reconstruction_error(part, scheme.reconstruct(part))


def test_the_order_of_the_repetitions_changes_no_error():
    for row, other in zip(table_1(lifts()).rows, table_1(shuffled(lifts())).rows):
        assert np.allclose(row[2:], other[2:], rtol=1e-6)


def test_recordings_pass_for_recordings_and_standing_still_does_not():
    same = table_2(drawing(lifts(), lifts().aligned)).rows
    assert all(p > 0.99 for row in same for p in row[1:])
    other = table_2(drawing(lifts(), still(lifts()))).rows
    assert all(p == 1 / (1 + tables.N_PERMUTATIONS) for row in other for p in row[1:])


def test_table_2_has_a_column_for_every_drawer_and_the_seed_decides_it():
    found = table_2(lifts())
    assert found.columns == ("part", *DRAWERS)
    assert found.rows == table_2(lifts()).rows
    assert found.rows != table_2(replace(lifts(), seed=2)).rows


def test_at_level_two_a_law_told_with_all_its_numbers_passes_and_one_with_fewer_does_not(monkeypatch):
    """Level one has 5 x 4 numbers. With 1 x 1 at level two much of what was drawn is lost."""
    found = {}
    for size in ((5, 4), (1, 1)):
        monkeypatch.setattr(tables, "LEVEL_DIMS", {"one": (5, 4), "two": size})
        found[size] = table_3(level_two(short(), 160, 60))
    whole, least = (numbers(found[size], "its own law") for size in ((5, 4), (1, 1)))
    assert np.all(whole > 0.05) and np.all(least < 0.01)


def test_table_3_has_the_p_values_of_level_two_in_its_order():
    rows = level_two(short(), 30, 10)
    assert [[row.level_two for row in two] for two in rows.values()] == [
        [one, one.replace("/IG", "/MVG"), "PWI"] for one in LEVEL_ONE
    ]
    assert table_3(rows).rows == tuple((one, *(row.p for row in two)) for one, two in rows.items())


def test_recordings_stray_as_far_as_themselves_and_go_the_same_ways(postures):
    four, five = tables_4_and_5(drawing(short(), short().aligned), postures)
    assert np.allclose(numbers(four, "|E - E of recordings|"), [0.0] * (1 + len(DRAWERS)), atol=1e-15)
    assert len(set(numbers(four, "Var E").round(12)[1:])) == 1
    assert numbers(five, "L1 norm")[1:].tolist() == [0.0] * len(DRAWERS)
    assert five.rows[0][0] == "uniform baseline" and five.rows[0][1] > 1


def test_standing_still_is_elsewhere_for_most_of_the_time_and_goes_no_way(postures):
    """E by hand: the share of time that the mean lift is not in the canonical posture it begins with."""
    four, five = tables_4_and_5(drawing(short(), still(short())), postures, ["still"])
    course = postures.labels(sphere.mean(short().aligned))
    begins = postures.labels(short().aligned[:, 0])
    assert postures.n_postures > 2 and set(begins) == {course[0]}
    assert four.rows[1][0] == "still" and four.rows[1][2] < 1e-30
    assert four.rows[1][1] == pytest.approx(np.mean(course != course[0]), rel=1e-12)
    assert four.rows[1][3] == pytest.approx(abs(four.rows[1][1] - four.rows[0][1]), rel=1e-12)
    assert four.rows[1][1] > 2 * four.rows[0][1] and five.rows[1][1] > 1


def test_the_order_of_the_repetitions_changes_neither_table_4_nor_5(postures):
    tables_of = [tables_4_and_5(drawing(c, short().aligned), postures) for c in (short(), shuffled(short()))]
    for one, other in zip(*tables_of):
        assert np.allclose([row[1:] for row in one.rows], [row[1:] for row in other.rows], atol=1e-12)


def test_canonical_postures_come_from_all_classes_and_the_seed_decides_the_sample(few):
    alone, again, other = quantized([short()], 0), quantized([short()], 0), quantized([short()], 7)
    assert np.array_equal(alone.sample, again.sample) and not np.array_equal(alone.sample, other.sample)
    turned = replace(short(), aligned=-short().aligned)
    both = quantized([short(), turned], 0)
    one, other = (set(both.labels(c.aligned).ravel().tolist()) for c in (short(), turned))
    assert one and other and not one & other


def test_classes_of_two_skeletons_are_not_quantized_together():
    motions = make("reach", 1, 1)[0]
    lump = replace(motions.skeleton, names=tuple("lump" if n == "head" else n for n in motions.skeleton.names))
    motions = replace(motions, motions=tuple(replace(m, skeleton=lump) for m in motions.motions))
    with pytest.raises(ValueError, match="found 2 skeletons, expected one"):
        quantized([short(), replace(short(), motions=motions)])


def one_bone_turning(n=6, n_times=20):
    """(n, T, 2, 3): one bone swings in a plane, each time its own way, the other stands."""
    angle = np.linspace(0.5, 1, n)[:, None] * np.sin(np.linspace(0, 3, n_times))
    x = np.zeros((n, n_times, 2, 3))
    x[..., 0, 0], x[..., 0, 2] = np.sin(angle), np.cos(angle)
    x[..., 1, 2] = 1.0
    return x


def turning():
    return replace(short(), aligned=one_bone_turning())


def test_fields_are_those_of_the_three_liveliest_channels():
    found = fields(short())
    for name, kind in (("S-TVF", STVF), ("IS-TVF", ISTVF)):
        flat, _ = kind.fit(short().aligned).forward(short().aligned[:2])
        spread = np.sort(flat.std(axis=(0, 1)))[::-1]
        assert found[name].shape == (2, flat.shape[1], 3)
        assert np.allclose(found[name].std(axis=(0, 1)), spread[:3])


def test_who_stands_still_has_no_velocity():
    assert all(np.abs(field).max() < 1e-12 for field in fields(replace(short(), aligned=still(short()))).values())


def test_flattening_comes_back_and_many_hops_do_not_come_back_in_one():
    errors = round_trip_errors(short())
    for name in ("IS-TVF", "SIEM", "M-TVF"):
        assert errors[name].shape == (31,) and errors[name].max() < 1e-11
    drift = errors["M-TVF, back in one hop"]
    assert drift[0] < 1e-12 and drift[-1] > 1e-3


def test_shares_of_space_fall_and_add_to_one():
    for share in spatial_shares(short()).values():
        assert np.isclose(share.sum(), 1) and np.all(np.diff(share) <= 1e-15) and len(share) > 2


def test_a_bone_that_swings_in_a_plane_has_one_direction():
    assert all(share[0] > 1 - 1e-9 for share in spatial_shares(turning()).values())


def test_functions_of_the_first_score_are_orthonormal_and_tell_it():
    scores, functions, share = first_score(short())
    assert scores.shape == (15, 31) and np.allclose(functions @ functions.T, np.eye(3))
    assert np.isclose(share.sum(), 1) and np.all(np.diff(share) <= 0)
    centred = scores - scores.mean(axis=0)
    told = centred @ functions.T @ functions
    assert np.isclose(np.sum(told**2) / np.sum(centred**2), share[:3].sum())


def test_the_order_of_the_repetitions_is_that_of_the_first_scores():
    scores, other = first_score(short())[0], first_score(shuffled(short()))[0]
    order = np.random.default_rng(5).permutation(15)
    sign = np.sign(np.sum(scores[order] * other))
    assert np.allclose(scores[order], sign * other, atol=1e-9)


@pytest.fixture(scope="module")
def by_size():
    return errors_by_size(short())


def test_more_numbers_lose_less(by_size):
    sizes, errors = by_size["JointPCA"]
    assert sizes == [4, 8, 12] and np.all(np.diff(errors) < 0)
    for name in ("SequentialPCA", "MPCA"):
        sizes, errors = by_size[name]
        assert sizes == [8, 16, 20, 50, 80, 100, 140]  # more functions of time than 14 are not to be had
        assert np.all(np.diff(errors)[1:] < 0)


def test_space_and_time_in_one_lose_least_for_as_many_numbers(by_size):
    eight = {name: errors[sizes.index(8)] for name, (sizes, errors) in by_size.items()}
    assert eight["JointPCA"] < eight["MPCA"] < eight["SequentialPCA"]


def test_coefficients_are_centred_and_their_spread_falls():
    found = first_coefficients(short())
    assert found.shape == (15, 2, 4) and np.abs(found.mean(axis=0)).max() < 1e-9
    assert np.all(np.diff(found.std(axis=0), axis=1) <= 1e-12)


def test_errors_fall_with_both_dimensions_and_few_are_not_told_from_the_originals():
    widths, errors, p = dimensions(short())
    assert widths == [2, 4, 7, 10]
    for of_one in errors.values():
        assert np.all(np.diff(of_one) < 0)
    assert np.all(np.array(errors[10]) < errors[5]) and min(p) > 0.5


def test_the_seed_decides_the_p_values_and_not_the_errors(monkeypatch):
    monkeypatch.setattr(flattening, "WIDTHS", (1,))
    rough = replace(short(), aligned=short().aligned[:, ::6])
    one, again, other = (dimensions(replace(rough, seed=seed)) for seed in (0, 0, 1))
    assert one == again and one[1] == other[1]
