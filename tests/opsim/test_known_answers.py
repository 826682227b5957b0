"""The files of ``tests/known_answers`` against theory, at a part of what ``make known-answers`` simulates.

On the compiled floor, and in ``make evidence`` on the interpreted one, whose rows are the same, with every log audited.

The chains behind the known answers of kits and batches, against what is known without them.

Bucket brigades against theory, from a scenario file: where people hand over, and how much they make.

``tests/known_answers/staffing.yaml`` against the recursion of a line: what variance between people costs.
"""

import numpy as np
import pytest
from known_answers import emulated_staffing, staffing
from known_answers.assembly import jobs_in_batches, kitting
from known_answers.cases import CASES, TAKE_LONG
from known_answers.chains import line_rate
from known_answers.crews import VELOCITIES, WORK_S, brigade, expected, positions, rates
from known_answers.simulate import simulate

from opsim.engine import FAST
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


@pytest.mark.slow
@pytest.mark.parametrize("case", HERE, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors(case, compiled):
    close_to_theory(case, compiled)


@pytest.mark.slow
@pytest.mark.parametrize("case", HERE, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors_with_simpy_and_all_laws_hold(case, interpreted):
    close_to_theory(case, interpreted)


@pytest.mark.parametrize("room", [1, 3])
def test_kits_without_work_go_as_a_walk_between_two_walls(room):
    """The lead of one part over the other is a walk from -room to room, all 2 room + 1 places alike."""
    rate, stock = kitting((1.0, 1.0), (1, 1), (room, room), 1e-6)
    assert rate == pytest.approx(2 * room / (2 * room + 1), rel=1e-4)
    assert stock((room, room)) == pytest.approx(room * (room + 1) / (2 * room + 1), rel=1e-4)


def test_batches_of_one_are_a_queue():
    assert jobs_in_batches(1, 1.0, 0.75) == pytest.approx(3.0, rel=1e-9)


@pytest.mark.parametrize("variant", VELOCITIES)
def test_slowest_to_fastest_hand_overs_and_rate_converge_to_theory(variant):
    handoffs, rate = expected(variant)
    found, finish_s, members = brigade(variant)
    for position, answer in zip(positions(found, members), handoffs, strict=True):
        assert np.abs(position[120:] - answer).max() <= 1e-9
        assert abs(position[0] - answer) > 1e-3  # they do not begin there
    assert np.abs(rates(finish_s)[120:] / rate - 1).max() <= 1e-9


def test_the_distance_from_where_they_end_up_shrinks_by_a_third_each_time():
    """Of two the map is x -> (v1 / v2) (1 - x): its slope is -1 / 1.5 (Bartholdi & Eisenstein 1996)."""
    found, _, members = brigade("two")
    away = positions(found, members)[0][:20] - 0.4
    assert away[1:] / away[:-1] == pytest.approx(np.full(19, -2 / 3), rel=1e-5)


def test_fastest_first_they_catch_up_and_come_out_in_bunches_at_the_pace_of_the_slowest():
    """Nobody hands over in the middle of work: all three are done with theirs when the slowest is."""
    found, finish_s, members = brigade("fastest_first")
    assert not any(position.size for position in positions(found, members))
    assert np.diff(finish_s).tolist() == [0.0, 0.0, WORK_S] * 118 + [0.0, 0.0]


def test_in_single_file_they_wait_behind_each_other_and_make_little_more_than_half():
    """Hand-overs end up where benches do, at 0.2 and 0.7: 3 h at pace 1 is all that v10 does of each piece."""
    found, finish_s, members = brigade("in_single_file")
    assert [position[-1] for position in positions(found, members)] == pytest.approx([0.2, 0.7], abs=1e-9)
    assert rates(finish_s)[-50:] == pytest.approx(np.full(50, 10 / 3), rel=1e-9)


@pytest.mark.slow
def test_variance_between_people_costs_a_line_what_the_recursion_says():
    runs = simulate(staffing.CASES, few=True)
    for variant, (mean, sd) in staffing.EXPECTED.items():
        rates = staffing.rates(runs, variant)
        spread = rates.std(ddof=1)
        assert abs(rates.mean() - mean) <= 4 * (spread**2 / len(rates) + staffing.ORACLE_ERROR**2) ** 0.5
        assert sd is None or abs(spread - sd) <= 4 * sd / (2 * (len(rates) - 1)) ** 0.5


@pytest.mark.slow
def test_it_costs_the_same_where_the_work_is_emulated(tmp_path):
    """100 people leave 4 % of doubt about the fitted CV and 10 % about its share: the rate moves by 1.5 % or so."""
    cases, mean_s = emulated_staffing.written(tmp_path, 100, 4)
    runs = simulate(cases, few=True)
    for case in cases:
        rates, (mean, _) = emulated_staffing.rates(runs, case, mean_s[case.variant]), staffing.EXPECTED[case.variant]
        error = (rates.var(ddof=1) / len(rates) + staffing.ORACLE_ERROR**2 + (0.0075 * mean) ** 2) ** 0.5
        assert abs(rates.mean() - mean) <= 3 * error
