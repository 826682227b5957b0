import pytest

from opsim.report.numbers import percent, rough, three_digits


@pytest.mark.parametrize(
    ("value", "said"), [(9.6191, "9.62"), (145.4, "145"), (1204.4, "1,204"), (999.7, "1,000"), (0.0, "0"), (23.0, "23")]
)
def test_three_digits_are_enough(value, said):
    assert three_digits(value) == said


def test_an_amount_has_the_unit_of_people():
    assert (rough(1384.0), rough(45.6, of=500.0), percent(0.356)) == ("23.1 min", "0.76 min", "36 %")
