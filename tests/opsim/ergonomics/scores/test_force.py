import pytest

from opsim.ergonomics.scores.tables import owas_load, reba_load, rula_force


@pytest.mark.parametrize(
    ("load_kg", "scores"),
    [(0, (0, 0, 0, 3)), (1.9, (0, 0, 0, 3)), (2, (1, 2, 2, 3)), (10, (1, 2, 2, 3)), (10.1, (2, 3, 3, 3))],
)
def test_rulas_force_is_as_in_the_papers_figure(load_kg, scores):
    patterns = ("intermittent", "repeated", "static", "shock")
    assert tuple(rula_force(load_kg, pattern) for pattern in patterns) == scores


def test_the_worksheet_counts_more_than_10_kg_as_3():
    assert [rula_force(kg, "intermittent", "worksheet") for kg in (10, 10.1)] == [1, 3]


def test_rebas_load_begins_at_5_kg_and_owas_after_10():
    assert [reba_load(kg) for kg in (4.9, 5, 10, 10.1)] == [0, 1, 1, 2] and reba_load(12, shock=True) == 3
    assert [owas_load(kg) for kg in (0, 10, 10.1, 20, 20.1)] == [1, 1, 2, 2, 3]


def test_unknown_words_are_refused_with_the_nearest():
    with pytest.raises(ValueError, match="no force 'statik'; did you mean 'static'"):
        rula_force(5, "statik")
    with pytest.raises(ValueError, match="no rule of force 'sheet'"):
        rula_force(5, "static", "sheet")
