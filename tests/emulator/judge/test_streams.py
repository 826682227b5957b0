import numpy as np

from emulator.judge.sequence_distances import stream


def numbers(*name):
    return stream(*name).random(5)


def test_a_name_has_its_numbers_and_no_other_name_has_them():
    given = numbers(7, "deep_squat", "PWI")
    assert np.array_equal(given, numbers(7, "deep_squat", "PWI"))
    others = [(8, "deep_squat", "PWI"), (7, "deep_squat"), (7, "PWI", "deep_squat"), (7, "deep_squatPWI")]
    assert not any(np.any(given == numbers(*other)) for other in others)
