"""Known answers on the fast engine: the same rows at a part of the horizon, and theory itself at the whole one.

``python -m known_answers.show --engine fast`` simulates all of them as often as their files ask for.

The fast engine writes the log of the SimPy engine of every shipped scenario, in every variant: to a quarter of its
horizon, and to all of it in the slow tests.

Two replications: the second is run on the floor that the first one leaves.

The fast engine writes the log of the SimPy engine, to the last bit, on random floors over the whole vocabulary.

``python -m engine_evidence.equality`` compares all 1,000; here is a sample that together uses every block, and a
deterministic part of the others in the slow tests.
"""

from dataclasses import replace

import pytest
from checked_floors import plan_of as floor_plan_of
from engine_evidence.floors import N_FLOORS, floor_text, replication_of
from engine_evidence.rows import first_difference
from engine_evidence.sample import SAMPLE
from known_answers import staffing
from known_answers.cases import CASES, TAKE_LONG
from known_answers.crews import VELOCITIES, brigade, expected, positions, rates
from known_answers.simulate import plan_of, simulate

from opsim.engine import FAST
from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.floor.run import run_plan as run_simpy
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder
from opsim.study.intervals import t_interval

ASKED = [*CASES, *staffing.CASES]
VARIANTS = sorted({(case.file, case.variant) for case in ASKED} | {("bucket_brigade", name) for name in VELOCITIES})
LONG = [case for case in CASES if (case.file, case.variant) in TAKE_LONG]
"""Which there is no time for with SimPy; the others are simulated with that in ``test_known_answers`` of ``opsim``."""
PART, LEAST_S = 50, 1000.0
"""One of so many parts of the horizon is compared row by row, but so much at least."""


@pytest.mark.slow
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


FILES = sorted(shipped_folder().glob("*.yaml"))
EACH = pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)


def difference(plan):
    """The first row that differs: on a new floor, or on one that has drawn most of its numbers ahead."""
    wanted, new = run_simpy(plan), run_fast(plan)
    return first_difference(wanted, new) or first_difference(wanted, run_fast(plan))


def plans(path, share=1.0):
    """{variant: Plan}; share : how much of the horizon is simulated."""
    read = {name: compile_plan(loaded) for name, loaded in scenarios_in(path.read_bytes(), path).items()}
    if share == 1.0:
        return read
    return {name: replace(plan, horizon_s=share * plan.horizon_s, warm_up_s=0.0) for name, plan in read.items()}


LONG_DRAWN = ("bench_height", "emptying_pallet", "rack_levels")
"""Each draws movements to many heights; ``shelf_heights`` does so, too."""
SHARED = [
    *((path, 0.25) for path in FILES if path.stem not in LONG_DRAWN),
    *(pytest.param(path, 1.0, marks=pytest.mark.slow) for path in FILES),
]


@pytest.mark.parametrize(("path", "share"), SHARED, ids=lambda value: getattr(value, "stem", value))
def test_every_variant_of_a_shipped_scenario_has_one_log(path, share):
    found = {name: difference(plan) for name, plan in plans(path, share).items()}
    assert found == dict.fromkeys(found, "")


@pytest.mark.slow
@EACH
def test_the_second_replication_has_one_log_too(path):
    for name, plan in plans(path).items():
        run_fast(plan)
        assert (name, first_difference(run_simpy(plan, 1), run_fast(plan, 1))) == (name, "")


DEAR = {187, 381}
"""Floors of the sample that take longest; without them each block is used once at least."""
EVERY = 4
"""Of the others, one of so many is run here."""
PARTS = 4


def floor_differs(number):
    """The first row that differs, in words; nothing where the logs are equal: on a new floor, and on one that has drawn
    most of its numbers ahead."""
    plan, replication = floor_plan_of(floor_text(number)), replication_of(number)
    wanted, new = run_simpy(plan, replication), run_fast(plan, replication)
    run_fast(plan, replication + 1)
    return first_difference(wanted, new) or first_difference(wanted, run_fast(plan, replication))


@pytest.mark.parametrize(
    "number", [pytest.param(number, marks=pytest.mark.slow) if number in DEAR else number for number in SAMPLE]
)
def test_a_floor_of_the_sample_has_one_log(number):
    assert floor_differs(number) == ""


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_many_random_floors_have_one_log(part):
    numbers = [number for number in range(0, N_FLOORS, EVERY) if number not in SAMPLE][part::PARTS]
    assert {number: words for number in numbers if (words := floor_differs(number))} == {}
