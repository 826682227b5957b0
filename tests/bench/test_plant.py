"""Fifty stations, thirty workers, three products: rows of the event log a CPU second, against the plain line."""

import pytest
from bench.cpu import best_s
from plans import line, plan

from opsim.engine.floor.run import run_plan

N_STATIONS, N_WORKERS, N_SKILLS = 50, 30, 4
LEAST = 0.6
"""Of the plain line's rows a second. With blocks 0.60 to 0.64, and 0.54 beside other work: only printed."""
SETUP = "setup: {otherwise: 20 s}"
JAM = "breakdowns: {jam: {every: {dist: exponential, mean: 1 h}, repair: {fixed: 2 min}, team: mechanics}}"


def plant(*, blocks: bool, horizon: str = "8 h") -> str:
    """Three products, each through two thirds of the stations; with blocks: set-ups, breakdowns, tools, rework, cards,
    a transporter and a conveyor too.
    """
    ranks = range(N_STATIONS)
    ways = [[f"s{i}" for i in ranks if i % 3 != product] for product in range(3)]
    more = [f", {SETUP}", f", {JAM}", ", needs: {jig: 1}", ", yield: 0.97", ", inspect: {}"]
    stations = [
        f"  s{i}: {{at: p{i}, tasks: [t{i}], servers: 2, buffer: 6{more[i % 10] if blocks and i % 10 < 5 else ''}}}"
        for i in ranks
    ]
    extra = [
        "tools: {jig: {n: 4}}",
        "repair_teams: {mechanics: {n: 2}}",
        "cards: {conwip: {n: 150}}",
        "conveyors: {belt: {from: p48, to: p49, speed: 0.5 m/s, pitch: 0.5 m}}",
        "transporters: {cart: {n: 2, at: p1, speed: 2 m/s, legs: [[s1, s3], [s4, s6], [s2, s4]]}}",
    ]
    if blocks:
        ways = [way if "s48" not in way or "s49" not in way else [*way[:-1], "belt", "s49"] for way in ways]
    skills = [", ".join(f"s{(w + N_WORKERS * k) % N_STATIONS}: 1.0" for k in range(N_SKILLS)) for w in range(N_WORKERS)]
    return "\n".join(
        [
            "opsim: 1",
            "name: Fifty stations",
            f"run: {{horizon: {horizon}, seed: 4}}",
            "layout: {places: {" + ", ".join(f"p{i}: [{2 * i} m, {i % 5} m]" for i in ranks) + "}}",
            "tasks: {" + ", ".join(f"t{i}: {{dist: exponential, mean: 20 s}}" for i in ranks) + "}",
            "stations:",
            *stations,
            "products:",
            *(
                f"  q{n}: {{share: 1/3, route: [{', '.join(way)}]}}".replace("1/3", str(1 / 3))
                for n, way in enumerate(ways)
            ),
            "release: {kind: poisson, every: 40 s}",
            "workers:",
            *(f"  w{w}: {{skills: {{{able}}}}}" for w, able in enumerate(skills)),
            *(extra if blocks else ()),
        ]
    )


@pytest.mark.parametrize("blocks", [False, True], ids=["plain stations", "with blocks"])
def test_rows_a_second_of_a_plant(blocks):
    plans = [plan(line(10, 5, horizon="4000 s", warm_up="0 s")), plan(plant(blocks=blocks))]
    rows = [len(run_plan(one)) for one in plans]
    seconds = best_s(*(lambda one=one: run_plan(one) for one in plans), rounds=3)
    by_line, by_plant = (n / s for n, s in zip(rows, seconds))
    share = by_plant / by_line
    print(f"\n{by_plant:,.0f} rows a CPU second, the plain line {by_line:,.0f}: {share:.2f} (target {LEAST})")
    assert rows[1] > 20_000
    assert blocks or share >= LEAST
