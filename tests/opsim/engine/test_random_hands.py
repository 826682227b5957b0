"""Random cells with tools, holds, teams, attended runs, defects and stops: every law holds, order decides nothing."""

import random

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.laws import audit
from opsim.log import COLUMNS, FINISH, HELD, NO_TOOL, REWORK, SCRAP, TEAM, TOOL, WAIT, WORK

KINDS = ("", "team: 2, ", "automatic: attended, ", "automatic: attended, team: 2, ", "automatic: true, ")


def cell(seed: int) -> dict[str, list[str]]:
    """Blocks of lines, with whole-second times so that ties are real."""
    rng = random.Random(seed)
    stations, tasks = range(rng.randint(2, 4)), []
    for i in stations:
        kind = rng.choice(KINDS)
        hold = kind in ("", "automatic: attended, ") and rng.random() < 0.6
        tool = f"hold: {{tool: gun, from: {rng.choice([0, 0.25])}, to: {rng.choice([0.5, 1])}}}, " if hold else ""
        needs = "needs: {jig: 1}, " if rng.random() < 0.4 else ""
        tasks.append(f"t{i}: {{{kind}{tool}{needs}fixed: {rng.randint(2, 8)} s, repeat: {rng.randint(1, 2)}}}")
    tasks.append(f"m: {{fixed: 4 s, hold: {{tool: gun, from: 0.5, to: 1}}, needs: {{jig: {rng.randint(1, 2)}}}}}")
    names = [f"s{i}" for i in stations]
    return {
        "tools": [f"gun: {{n: {rng.randint(1, 2)}}}", "jig: {n: 3}"],
        "tasks": tasks,
        "stations": [station(rng, i, names) for i in stations],
        "products": [
            f"a: {{share: 0.5, priority: {rng.randint(0, 1)}, route: [{', '.join(names)}]}}",
            f"b: {{share: 0.5, route: [{', '.join(reversed(names))}]}}",
        ],
        "workers": [f"w{j}: {{walk: 1 m/s, skills: {{{skills(rng, names, j)}}}}}" for j in range(rng.randint(2, 4))],
    }


def station(rng: random.Random, i: int, names: list[str]) -> str:
    said = [f"at: p{rng.randint(0, 2)}", f"tasks: [{rng.choice(['t{0}', 't{0}, m', 'm, t{0}']).format(i)}]"]
    said += [f"servers: {rng.randint(1, 2)}"]
    said += rng.choice([[], ["needs: {jig: 1}"]]) + rng.choice([[], ["yield: 0.7"]])
    then = rng.choice(["scrap", f"{{rework: s{i}}}"])
    said += rng.choice([[], [], [f"inspect: {{finds: 0.8, false_alarms: 0.1, then: {then}}}"]])
    said += rng.choice([[], [f"preempt: {rng.choice(['resume', 'restart'])}"]])
    job = rng.choice(["resume", "restart", "scrap"])
    every = f"{{fixed: {rng.randint(7, 15)} s}}"
    jam = f"breakdowns: {{jam: {{every: {every}, by: busy, repair: {{fixed: 5 s}}, job: {job}}}}}"
    return f"s{i}: {{{', '.join(said + rng.choice([[], [jam]]))}}}"


def skills(rng: random.Random, names: list[str], number: int) -> str:
    return ", ".join(f"{name}: 1.0" for name in names if number < 2 or rng.random() < 0.5)


def text(blocks: dict[str, list[str]], when_blocked: str = "free") -> str:
    head = f"""
opsim: 1
name: hands
run: {{horizon: 15 min, seed: 4}}
layout: {{places: {{p0: [0 m, 0 m], p1: [2 m, 0 m], p2: [3 m, 1 m]}}}}
allocation: {{when_blocked: {when_blocked}}}
release: {{kind: renewal, every: {{fixed: 12 s}}}}
"""
    return head + "\n".join(line for name, lines in blocks.items() for line in (f"{name}:", *(f"  {x}" for x in lines)))


def rows(log):
    named = {c: np.array([*log.names[c], ""], dtype=object)[log[c]] for c in log.names}
    return list(zip(*(map(str, named.get(c, log[c])) for c in COLUMNS)))


@pytest.mark.parametrize("seed", range(12))
def test_the_laws_hold_with_hands_full(seed):
    p = plan(text(cell(seed), when_blocked=("free", "held")[seed % 2]))
    audit(run_plan(p), p)


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_declaration_decides_nothing(seed):
    blocks = cell(seed)
    turned = {name: lines[::-1] for name, lines in reversed(blocks.items())}
    assert rows(run_plan(plan(text(blocks)))) == rows(run_plan(plan(text(turned))))


def test_all_of_it_happens_in_these_cells():
    seen = dict.fromkeys(("tool", "team", "rework", "scrap", "wait", "finish"), 0)
    for seed in range(12):
        log = run_plan(plan(text(cell(seed))))
        seen["tool"] += int(np.sum(log["kind"] == TOOL))
        seen["team"] += int(np.sum((log["kind"] == WAIT) & (log["cause"] == TEAM)))
        seen["wait"] += int(np.sum((log["kind"] == HELD) & (log["cause"] == NO_TOOL)))
        for name, kind in (("rework", REWORK), ("scrap", SCRAP), ("finish", FINISH)):
            seen[name] += len(log.of(kind))
    assert min(seen.values()) > 50, seen


@pytest.mark.parametrize("seed", range(12))
def test_no_more_tools_are_held_than_there_are_and_no_worker_works_twice(seed):
    p = plan(text(cell(seed)))
    log = run_plan(p)
    tools = log.of(TOOL)
    for rank, tool in enumerate(p.tools):
        here = tools["k"] == rank
        times = np.concatenate([tools["end_s"][here], tools["start_s"][here]])
        steps = np.repeat([-1, 1], here.sum())
        order = np.lexsort([steps, times])
        assert np.cumsum(steps[order]).max(initial=0) <= tool.n
    work = log.of(WORK)
    pairs = list(zip(work["worker"], work["task"], work["k"], work["progress_from"], work["station"]))
    assert len(set(pairs)) >= len([pair for pair in pairs if pair[0] >= 0]) * 0.99
