from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.judge import paper as tables
from emulator.judge.paper import DRAWERS, LEVEL_ONE, level_two, quantized, table_1, table_2, table_3, tables_4_and_5
from emulator.judge.posture_tests import reconstruction_error
from emulator.schemes import Scheme
from emulator.synthetic.tasks import make
from tests.emulator.judge.paper.classes import drawing, lifts, short, shuffled, still


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
