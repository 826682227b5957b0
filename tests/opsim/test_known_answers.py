"""The files of ``tests/known_answers`` against theory, at a part of what ``make known-answers`` simulates.

On the compiled floor, and in ``make evidence`` on the interpreted one, whose rows are the same, with every log audited.
"""

import pytest
from known_answers.cases import CASES, TAKE_LONG
from known_answers.chains import line_rate
from known_answers.simulate import simulate

from opsim.engine.choice import FAST
from opsim.study.intervals import t_interval

HERE = [case for case in CASES if (case.file, case.variant) not in TAKE_LONG]
"""The others are simulated by ``make known-answers`` and, on the compiled floor, by its own ``test_known_answers``."""


@pytest.fixture(scope="module")
def compiled():
    return simulate(HERE, few=True, engine=FAST, audited=False)


@pytest.fixture(scope="module")
def interpreted():
    """Floor and audit as they are written: minutes, where the compiled one takes seconds."""
    HERE[0].answer()
    return simulate(HERE, few=True)


@pytest.mark.parametrize(("mean_s", "phases", "rate"), [
    ((1.0, 1.0), 1, 2 / 3),  # Hunt 1956
    ((1.0, 1.0, 1.0), 1, 22 / 39),  # Hillier & Boling 1967
    ((1.0, 1.0), 2, 8 / 11),  # 1 / E max(X1, X2)
])  # fmt: skip
def test_the_chain_gives_the_rates_of_the_books(mean_s, phases, rate):
    assert line_rate(mean_s, phases) == pytest.approx(rate, rel=1e-12)


def test_a_faster_station_in_the_middle_beats_a_balanced_line():
    arch, balanced, bowl = (line_rate((1.5 - middle / 2, middle, 1.5 - middle / 2)) for middle in (1.2, 1.0, 0.8))
    assert arch < balanced < bowl


def close_to_theory(case, runs):
    interval = t_interval(runs[case.file, case.variant][case.kpi])
    standard_error = interval.sd / interval.n**0.5
    assert interval.half_width <= 0.05 * interval.mean
    assert abs(interval.mean - case.answer()) <= 4 * standard_error + 1e-6 * case.answer()


@pytest.mark.parametrize("case", HERE, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors(case, compiled):
    close_to_theory(case, compiled)


@pytest.mark.slow
@pytest.mark.parametrize("case", HERE, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors_with_simpy_and_all_laws_hold(case, interpreted):
    close_to_theory(case, interpreted)
