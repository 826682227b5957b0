"""Random scenarios: every law holds, and the order of declaration decides nothing even where times tie."""

import random

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from plans import plan

from opsim.laws import CHECKS, audit
from opsim.engine.simpy_engine import run_plan
from opsim.kpi import figures
from opsim.log import COLUMNS

RELEASES = ("{kind: saturated}", "{kind: poisson, every: 3 s}", "{kind: poisson, every: 3 s, when_full: lose}")


@st.composite
def floors(draw):
    """A scenario as blocks of lines, with whole-second times so that ties are real."""
    n_stations, n_workers = draw(st.integers(1, 4)), draw(st.integers(1, 4))
    seconds = st.integers(1, 4)
    more = [(draw(seconds), draw(st.integers(1, 2)), str(draw(st.booleans())).lower()) for _ in range(n_stations)]
    tasks = [f"t{i}: {{fixed: {s} s, repeat: {n}, automatic: {a}}}" for i, (s, n, a) in enumerate(more)]
    manual = "m: {fixed: 2 s}"
    stations = []
    for i in range(n_stations):
        work = draw(st.sampled_from([[f"t{i}"], ["m", f"t{i}"], [f"t{i}", "m"], ["m", f"t{i}", "m"]]))
        stations.append(
            f"s{i}: {{at: p{draw(st.integers(0, 2))}, tasks: [{', '.join(work)}], "
            f"servers: {draw(st.integers(1, 2))}, buffer: {draw(st.integers(0, 2))}}}"
        )
    routes = [draw(st.permutations(range(n_stations))) for _ in range(draw(st.integers(1, 2)))]
    steps = [[f"s{i}" for i in route] for route in routes]
    parallel = draw(st.booleans()) and n_stations > 2
    products = [
        f"q{r}: {{share: {1 / len(routes)}, route: [{', '.join([f'[{s[0]}, {s[1]}]', *s[2:]] if parallel else s)}]}}"
        for r, s in enumerate(steps)
    ]
    workers = [
        f"w{i}: {{walk: {draw(st.integers(1, 2))} m/s, skills: {{"
        + ", ".join(f"s{j}: 1.0" for j in range(n_stations) if i == 0 or draw(st.booleans()))
        + "}}"
        for i in range(n_workers)
    ]
    return {
        "tasks": [*tasks, manual],
        "stations": stations,
        "products": products,
        "workers": workers,
        "release": draw(st.sampled_from(RELEASES)),
        "rule": draw(st.sampled_from(["longest_queue", "nearest", "oldest_job"])),
        "blocked": draw(st.sampled_from(["free", "held"])),
    }


def text_of(blocks: dict, order: random.Random | None = None) -> str:
    lines = ["opsim: 1", "name: random", "run: {horizon: 200 s, warm_up: 20 s, seed: 3}"]
    lines.append("layout: {places: {p0: [0 m, 0 m], p1: [3 m, 0 m], p2: [3 m, 4 m]}}")
    for block in ("tasks", "stations", "products", "workers"):
        entries = list(blocks[block])
        if order is not None:
            order.shuffle(entries)
        lines += [f"{block}:", *(f"  {entry}" for entry in entries)]
    lines.append(f"release: {blocks['release']}")
    lines.append(f"allocation: {{rule: {blocks['rule']}, when_blocked: {blocks['blocked']}}}")
    return "\n".join(lines)


@settings(max_examples=60, deadline=None)
@given(floors(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing(blocks, shuffle):
    p = plan(text_of(blocks))
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert all(np.isnan(f.value) or f.value >= -1e-9 for f in figures(log, p))
    again = run_plan(plan(text_of(blocks, random.Random(shuffle))))
    assert again.names == log.names
    assert all(np.array_equal(again[c], log[c], equal_nan=log[c].dtype.kind == "f") for c in COLUMNS)
