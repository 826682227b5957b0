import pytest

from opsim.ergonomics.scores.tables import owas_level, reba_level, rula_level


def test_every_score_has_the_level_of_its_paper():
    assert [rula_level(score).number for score in range(1, 8)] == [1, 1, 2, 2, 3, 3, 4]
    assert [reba_level(score).number for score in range(1, 16)] == [0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 4, 4, 4, 4, 4]
    assert [owas_level(score).number for score in range(1, 5)] == [1, 2, 3, 4]


def test_levels_have_the_published_words():
    assert rula_level(7).text == "investigation and changes required immediately"
    assert reba_level(8).text.startswith("high risk") and owas_level(4).text == "extremely harmful, action immediately"


@pytest.mark.parametrize(("level", "score", "most"), [(rula_level, 0, 7), (reba_level, 16, 15), (owas_level, 2.5, 4)])
def test_what_is_no_score_is_refused(level, score, most):
    with pytest.raises(ValueError, match=f"no score {score}, expected 1 to {most}"):
        level(score)
