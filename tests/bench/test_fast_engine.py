"""The fast engine, event log on: against SimPy by hand, against our SimPy engine, against drawing alone.

Every answer is asserted before it is timed: the rows are those of the SimPy engine. Compiled code is warm, and what is
timed is one replication of a Plan after another, as in a study.
"""

from dataclasses import replace
from time import process_time

import pytest
from bench.cpu import best_s
from bench.fast_runs import in_a_process
from bench.peers import compare, in_opsim, in_opsim_fast
from bench.test_plant import plant
from engine_evidence.rows import first_difference
from plans import plan

from opsim.engine.fast_engine import run_plan as run_fast
from opsim.engine.fast_engine.numbers import NAMED
from opsim.engine.fast_engine.run import machine_of
from opsim.engine.fast_engine.streams.of_plan import BlockDraws
from opsim.engine.floor.run import run_plan as run_simpy
from opsim.plan import Plan, compile_plan
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder
from opsim.tasks import Fixed, Lognormal

ROUNDS = 5
BY_HAND, STRETCH, OUR_SIMPY, OF_DRAWING = 50, 100, 50, 1.5
REPLICATIONS, FEW, MANY_TIMES = 1000, 20, 40
CV = 0.25


@pytest.mark.parametrize(
    ("variant", "until_s"),
    [("line", 80_000), ("line_manned", 40_000), ("pool", 30_000), ("mm1", 400_000), ("mm1_manned", 200_000)],
)
def test_against_simpy_by_hand(variant, until_s):
    model = variant.split("_")[0]
    by_hand = next(one for one in compare.runners() if (one.label, one.model) == ("SimPy by hand", model))
    ours = compare.Runner("opsim fast", model, variant, until_s, getattr(in_opsim_fast, variant), compare.NAMED)
    assert all(compare.agree(*compare.exact(one)) for one in (ours, by_hand))
    _equal(in_opsim.PLANS[variant](until_s / 20, 1))
    timed = in_opsim.PLANS[variant](until_s, 1)
    speeds = [(_jobs_per_s(model, timed, r), compare.jobs_per_cpu_s(by_hand, r)) for r in range(ROUNDS + 1)][1:]
    fast, simpy = map(max, zip(*speeds))
    _told(f"{variant}, {fast / 1e6:.2f} million jobs a CPU second", fast / simpy, f"SimPy by hand (target {BY_HAND}, "
          f"stretch {STRETCH})")  # fmt: skip


def _jobs_per_s(model: str, timed: Plan, replication: int) -> float:
    """Of a replication with its rows; the answer is looked at beside."""
    started = process_time()
    log = run_fast(timed, replication)
    spent = process_time() - started
    found = (in_opsim_fast._rate if model == "line" else in_opsim_fast._times)(log)
    assert compare.answers.long_run_error(model, found) < compare.MOST_ERRORS
    return found[0] / spent


LOGNORMAL = ("dist: exponential, mean: 20 s", "dist: lognormal, mean: 20 s, cv: 0.5, between_share: 0.5")
PLANTS = {
    "fifty stations": lambda: plan(plant(blocks=False).replace(*LOGNORMAL)),
    "fifty stations with blocks": lambda: plan(plant(blocks=True).replace(*LOGNORMAL)),
    "two_shift_plant": lambda: _lognormal(_shipped("two_shift_plant")),
    "pump_plant": lambda: _lognormal(_shipped("pump_plant")),
}


@pytest.mark.parametrize("name", PLANTS)
def test_against_our_simpy_engine(name):
    made = PLANTS[name]()
    rows = _equal(made)
    fast_s, simpy_s = best_s(lambda: run_fast(made, 1), lambda: run_simpy(made, 1), rounds=3)
    fast_s = min(fast_s, *best_s(lambda: run_fast(made, 1), rounds=10))
    _told(f"{name}, {rows} rows, {rows / fast_s / 1e6:.2f} million a CPU second", simpy_s / fast_s, f"our SimPy engine "
          f"(target {OUR_SIMPY})")  # fmt: skip


@pytest.mark.parametrize("name", ["repack_cell", "eight_station_cell", "two_shift_plant"])
def test_against_drawing_alone(name):
    """Drawing: all numbers that the run has drawn, by the engine's own arrays of blocks, and nothing else."""
    made = _shipped(name)
    _equal(made)
    run_fast(made, 1)
    asked = dict(machine_of(made).numbers.drawn)

    def draw():
        draws = BlockDraws(made, 1)
        for stream, blocks in asked.items():
            ranks = stream >> 32 & 0xFFFF, stream >> 16 & 0xFFFF, stream & 0xFFFF
            NAMED[stream >> 48](draws, made, *ranks).fill(0, blocks)

    run_s, draw_s, simpy_s = best_s(lambda: run_fast(made, 1), draw, lambda: run_simpy(made, 1), rounds=9)
    told = f"{name} with its emulators, {1e3 * run_s:.1f} ms, {simpy_s / run_s:.0f} x our SimPy engine"
    _told(told, run_s / draw_s, f"drawing alone (target {OF_DRAWING})")


def test_a_thousand_replications_on_two_cores():
    """SimPy's time is that of a few, times as many; by the clock, and by CPU, which a busy machine tells too."""
    engines = {"simpy": FEW, "fast": REPLICATIONS}
    rounds = [{engine: in_a_process("replications", engine, n) for engine, n in engines.items()} for _ in range(3)]
    assert rounds[0]["simpy"]["jobs"] == rounds[0]["fast"]["jobs"][:FEW]
    best = {
        engine: [min(one[engine][of] for one in rounds) * REPLICATIONS / n for of in ("clock_s", "cpu_s")]
        for engine, n in engines.items()
    }
    simpy_s, simpy_cpu_s = best["simpy"]
    for engine, (clock_s, cpu_s) in best.items():
        what = f"1,000 replications by {engine}: {clock_s:.2f} s by the clock, {cpu_s:.2f} s of CPU"
        _told(f"{what}, {simpy_cpu_s / cpu_s:.0f} x by CPU", simpy_s / clock_s, f"SimPy (target {MANY_TIMES})")


def _shipped(name: str) -> Plan:
    path = shipped_folder() / f"{name}.yaml"
    return compile_plan(scenarios_in(path.read_bytes(), path)["base"])


def _lognormal(made: Plan) -> Plan:
    """The plan with a lognormal time of the same mean for every task that is not fixed: from recordings too."""
    tasks = (
        task if isinstance(task.model, Fixed) else replace(task, model=Lognormal(task.model.mean_duration_s(), CV))
        for task in made.tasks
    )
    return replace(made, tasks=tuple(tasks))


def _equal(made: Plan) -> int:
    """Rows of a replication, which are those of the SimPy engine to the last bit."""
    log = run_simpy(made, 1)
    assert first_difference(log, run_fast(made, 1)) == ""
    return len(log)


def _told(what: str, times: float, of: str) -> None:
    print(f"\n{what}: {times:.2f} x {of}", end="")
