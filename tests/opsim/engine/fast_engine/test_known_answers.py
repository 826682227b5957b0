"""Known answers on the fast engine: the same rows at a part of the horizon, and theory itself at the whole one.

``python -m known_answers.show --engine fast`` simulates all of them as often as their files ask for.
"""

from dataclasses import replace

import pytest
from engine_evidence.rows import first_difference
from known_answers import staffing
from known_answers.cases import CASES, TAKE_LONG
from known_answers.crews import VELOCITIES, brigade, expected, positions, rates
from known_answers.simulate import plan_of, simulate

from opsim.engine.choice import FAST
from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor import run_plan as run_simpy
from opsim.study.interval import t_interval

ASKED = [*CASES, *staffing.CASES]
VARIANTS = sorted({(case.file, case.variant) for case in ASKED} | {("bucket_brigade", name) for name in VELOCITIES})
LONG = [case for case in CASES if (case.file, case.variant) in TAKE_LONG]
"""Which there is no time for with SimPy; the others are simulated with that in ``test_known_answers`` of ``opsim``."""
PART, LEAST_S = 50, 1000.0
"""One of so many parts of the horizon is compared row by row, but so much at least."""


def test_every_known_answer_is_simulated_from_the_same_rows():
    n_rows = []
    for file, variant in VARIANTS:
        whole = plan_of(file, variant)
        part_s = max(whole.horizon_s / PART, min(LEAST_S, whole.horizon_s))
        plan = replace(whole, horizon_s=part_s, warm_up_s=0.0)
        log = run_simpy(plan, 1)
        assert (file, variant, first_difference(log, run_fast(plan, 1))) == (file, variant, "")
        n_rows.append(len(log))
    assert min(n_rows) >= 10 and sum(n_rows) > 10_000


@pytest.mark.parametrize("variant", VELOCITIES)
def test_a_brigade_hands_over_where_theory_says(variant):
    handoffs, rate = expected(variant)
    found, finish_s, members = brigade(variant, FAST)
    last = [float(position[-1]) for position in positions(found, members)]
    assert [*last, float(rates(finish_s)[-1])] == pytest.approx([*handoffs, rate], rel=1e-9)


@pytest.fixture(scope="module")
def runs():
    return simulate(LONG, few=True, engine=FAST, audited=False)


@pytest.mark.slow
@pytest.mark.parametrize("case", LONG, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors(case, runs):
    interval = t_interval(runs[case.file, case.variant][case.kpi])
    assert abs(interval.mean - case.answer()) <= 4 * interval.sd / interval.n**0.5 + 1e-6 * case.answer()
