import pytest

from opsim.human.fatigue import ErrorsByFatigue


@pytest.mark.parametrize(("level", "good"), [(0.0, 1.0), (0.5, 0.9), (1.0, 0.8), (1.7, 0.8), (-0.1, 1.0)])
def test_the_chance_of_a_defect_grows_with_fatigue(level, good):
    """A fifth at full fatigue: half as tired, a tenth."""
    assert ErrorsByFatigue(at_full_fatigue=0.2).share_of_good(level) == pytest.approx(good)


def test_without_errors_all_work_of_the_tired_is_good():
    assert all(ErrorsByFatigue(at_full_fatigue=0.0).share_of_good(level / 7) == 1.0 for level in range(8))
