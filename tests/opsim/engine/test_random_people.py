"""Random scenarios over everything that people may do: every law holds, and the order of declaration decides nothing.

Each has shifts and breaks, some blocks about people and some about material and stations. A rule of interruption is
contested where a log shows what it does and the others would not; any other block where the log would be another
without it, or shows what only it does.

Random cells with tools, holds, teams, attended runs, defects and stops: every law holds, order decides nothing.

Random crews obey all laws; nobody overtakes, nobody else works there, and the line never stands for good.

Random floors whose stations and sources open and close: the laws hold, and the order of declaration decides nothing.

A scenario is told of where jobs stood on a closed station, and some of its work went on after closing, or was stopped.

Random floors with everything people may do: neutral effects change no bit, and with all effects on every law holds.

So the law of pace finds each time in its draw, the repetitions read from the rows and the shift of the row, whatever
breaks work off, hands it over or lets it wait. Without a pace by the state of the line, the law of fatigue also finds
each shift in the worker's day.
"""

from __future__ import annotations

import json
import random
from collections import Counter
from collections.abc import Callable, Collection
from functools import partial
from itertools import combinations

import numpy as np
import pytest
import yaml
from checked_floors import checked, differ, plan_of
from choices import Drawn, Lots
from contests import CONTESTED, contested, met_at_work
from human_plans import NEUTRAL
from hypothesis import given, settings
from hypothesis import strategies as st
from made.blocks import BLOCKS, floor_with
from made.brigades import scenario
from made.crews import CREWS
from made.floors import text_of
from made.people_blocks import ALWAYS, PEOPLE, people_floor_with
from made.troubles import troubled
from naive.people import jumps, unjoined
from plans import plan, ran
from shown_blocks import shown

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import CHECKS, audit
from opsim.log import (
    CLOSED,
    COLUMNS,
    FINISH,
    HELD,
    JOB_KINDS,
    NO_TOOL,
    OFF,
    REWORK,
    SCRAP,
    SETUP,
    TEAM,
    TOOL,
    WAIT,
    WORK,
    EventLog,
)
from opsim.plan import Plan

ENOUGH = 25
AT_LEAST = 2
"""Interruptions in each scenario that counts."""
SELDOM = ("zones", "zones", "zones", "choice_of_work", "overtime", "overtime", "floaters", "station_priorities")
"""Blocks that seldom matter, by how many times more they are chosen."""


def chosen(pick) -> list[str]:
    """Two to five blocks about people, those that seldom matter more often, and up to three others."""
    of_people = [name for name in (*PEOPLE, *CREWS, *SELDOM) if name not in ALWAYS]
    mine = list(dict.fromkeys(pick.shuffled(of_people)))[: pick.whole(2, 5)]
    return [*ALWAYS, *mine, *pick.shuffled(list(BLOCKS))[: pick.whole(0, 3)]]


def check(values: dict, shuffle: int) -> tuple[EventLog, Plan]:
    """The log of a scenario, once what holds of any floor has held, and what was written to be read of people."""
    log, plan = checked(values, shuffle)
    assert list(jumps(log, plan)) == []
    assert list(unjoined(log)) == []
    return log, plan


def shown_by(seed: int, wanted: Callable[..., list[str]] = chosen, enough: Collection[str] = ()) -> list[str] | None:
    """The rules and blocks that a scenario contests, but for those that are told of often enough; None where fewer than
    two interruptions are in it.
    """
    pick = Lots(seed)
    blocks = wanted(pick)
    values = people_floor_with(pick, blocks)
    log, p = check(values, seed)
    mets = met_at_work(log, p)
    if len(mets) < AT_LEAST:
        return None
    asked = [name for name in dict.fromkeys(blocks) if name not in BLOCKS and name not in enough]
    return [*contested(mets), *(name for name in asked if shown(name, values, log, p))]


@settings(max_examples=15, deadline=None)
@given(st.data(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing_with_people_and_everything_else(data, shuffle):
    pick = Drawn(data.draw)
    check(people_floor_with(pick, chosen(pick)), shuffle)


@pytest.mark.slow
def test_every_rule_is_contested_by_25_of_500_random_scenarios_with_two_interruptions_each():
    seen, n, seed = Counter[str](), 0, 0
    while n < 500 and seed < 800:
        found = shown_by(seed, enough=[name for name in seen if seen[name] >= ENOUGH])
        seed += 1
        if found is not None:
            n += 1
            seen.update(set(found))
    assert n == 500
    assert {name: seen[name] for name in (*CONTESTED, *PEOPLE, *CREWS) if seen[name] < ENOUGH} == {}


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2))])
@pytest.mark.parametrize("block", [name for name in (*PEOPLE, *CREWS) if name not in ALWAYS])
def test_each_block_alone_keeps_the_laws(block, seed):
    shown_by(seed, partial(lambda name, _pick: [*ALWAYS, name], block))


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


FEW, MANY = range(12), range(12, 160)


def left_s(log, made):
    """{station: {job: when it left it}} of jobs that went on from there, or are done with the line."""
    found: dict[int, dict[int, float]] = {}
    rows = log.of(*JOB_KINDS)
    for i in range(len(rows)):
        station, job, product = (int(rows[name][i]) for name in ("station", "job", "product"))
        out = made.products[product].route[-1].stations == (station,) and station != made.crews[0].stations[-1]
        if station >= 0 and not out:  # who goes out in the middle of the line is in nobody's way
            found.setdefault(station, {})[job] = float(rows["end_s"][i])
    return {station: {job: s for job, s in jobs.items() if s < log.horizon_s} for station, jobs in found.items()}


def crews_keep_laws(seed):
    log, made = ran(scenario(seed))
    (crew,) = made.crews
    work = log.of(WORK)
    manned = work["worker"][work["worker"] >= 0]
    assert set(manned.tolist()) <= set(crew.workers)
    left = left_s(log, made)
    for before, after in combinations(crew.stations, 2):
        both = sorted(set(left.get(before, ())) & set(left.get(after, ())))
        first = np.array([left[before][job] for job in both])
        then = np.array([left[after][job] for job in both])
        order = np.lexsort([then, first])
        apart = np.diff(first[order]) > 0
        assert np.all(np.diff(then[order])[apart] >= 0), f"seed {seed}: overtaken after station {after}"
    if "saturated" in scenario(seed) and '"scrap"' not in scenario(seed):
        assert log["end_s"][log["kind"] == FINISH].max(initial=0) > 0.8 * log.horizon_s, f"seed {seed} stands still"


@pytest.mark.parametrize("seed", FEW)
def test_a_random_crew_obeys_all_laws(seed):
    crews_keep_laws(seed)


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [MANY[start::4] for start in range(4)])
def test_many_random_crews_obey_all_laws(seeds):
    for seed in seeds:
        crews_keep_laws(seed)


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_declaration_decides_nothing_with_crews(seed):
    made = json.loads(scenario(seed))
    turned = {key: dict(reversed(block.items())) if isinstance(block, dict) else block for key, block in made.items()}
    logs = [run_plan(plan(json.dumps(one))) for one in (made, turned)]
    for name in ("kind", "start_s", "end_s", "worker", "station", "job", "task"):
        assert np.array_equal(logs[0][name], logs[1][name])


OFTEN = 25


def with_hours(pick) -> dict:
    """A made floor of 20 minutes in which stations and sources have one to three of three windows."""
    values = floor_with(pick, pick.shuffled(list(BLOCKS))[: pick.whole(0, 5)])
    edges = sorted(pick.shuffled(range(10, 1190))[:6])
    clock = [f"06:{second // 60:02d}:{second % 60:02d}" for second in edges]
    windows = zip("abc", clock[::2], clock[1::2])
    values["shifts"] = {name: {"from": begins, "to": ends} for name, begins, ends in windows}
    for station in values["stations"].values():
        if pick.whole(0, 4) < 3:
            station |= {"shift": _some(pick), "at_close": pick.one_of(["finish", "resume"])}
    for source in [values["release"]] if "release" in values else values["sources"].values():
        if pick.whole(0, 4) < 2:
            source["shift"] = _some(pick)
    return values


def _some(pick) -> list[str] | str:
    names = pick.shuffled("abc")[: pick.whole(1, 3)]
    return names if len(names) > 1 else names[0]


def told(log, plan) -> set[str]:
    """What closing did: jobs stood, work went on after it, work was broken off at it."""
    found = {"stood"} if (log["cause"] == CLOSED).any() else set()
    at_work = log.of(WORK, SETUP)
    off = log.of(OFF)
    for station, closes_s in zip(off["station"].tolist(), off["start_s"].tolist()):
        here = at_work.where(at_work["station"] == station)
        if ((here["start_s"] < closes_s) & (here["end_s"] > closes_s)).any():
            found.add("finished")
        if ((here["end_s"] == closes_s) & (here["progress_to"] < 1)).any():
            found.add("stopped")
    return found


@pytest.mark.slow
def test_laws_hold_and_declaration_order_decides_nothing_whatever_opens_and_closes():
    seen: Counter[str] = Counter()
    for seed in range(200):
        seen.update(told(*checked(with_hours(Lots(seed)), seed + 1)))
    assert seen["stood"] >= OFTEN and seen["finished"] >= OFTEN and seen["stopped"] >= OFTEN, seen


def test_a_few_of_them():
    for seed in range(200, 210):
        checked(with_hours(Lots(seed)), seed + 1)


ALL = """
human:
  learning: {model: dual_phase, measured_at: 30}
  forgetting: {model: lfcm, forgotten_in: 2 d, least_pause: 1 min}
  state_pace: {model: schultz, faster: 0.3, slower: 0.2}
  circadian: {amplitude: 0.2}
  fatigue: {model: lffrm, tires_half_in: 30 min}
  rest: {above: 0.5, until: 0.3}
  errors: {at_full_fatigue: 0.2}
"""
NO_STATE_PACE = ALL.replace("  state_pace: {model: schultz, faster: 0.3, slower: 0.2}\n", "")


def made(seed, human="", troubles=False):
    """The text of a floor with shifts, breaks and up to seven other blocks; with what breaks work off, or without."""
    pick = Lots(seed)
    mine = pick.shuffled([name for name in (*PEOPLE, *CREWS) if name not in ALWAYS])[: pick.whole(1, 4)]
    values = people_floor_with(pick, [*ALWAYS, *mine, *pick.shuffled(list(BLOCKS))[: pick.whole(0, 3)]])
    if troubles:
        values = troubled(pick, values)
    return text_of(values | yaml.safe_load(human or "{}"))


def keeps_laws(seed, human=ALL, troubles=False):
    """How many shifts of times the floor saw with all effects on."""
    plain, neutral = (plan_of(made(seed, effects, troubles)) for effects in ("", NEUTRAL))
    assert differ(run_plan(plain), run_plan(neutral)) == []
    plan = plan_of(made(seed, human, troubles))
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    return np.unique(log["pace_shift"][log["kind"] == WORK]).size


@pytest.mark.parametrize("seed", range(4))
def test_neutral_effects_change_no_bit_and_others_keep_every_law(seed):
    keeps_laws(seed)


@pytest.mark.slow
def test_neutral_effects_change_no_bit_and_others_keep_every_law_on_many_floors():
    assert sum(keeps_laws(seed) > 2 for seed in range(4, 34)) > 20


@pytest.mark.parametrize("human", [ALL, NO_STATE_PACE], ids=["all", "no_state_pace"])
@pytest.mark.parametrize("seed", [13, 14, 64])
def test_they_keep_every_law_where_work_is_broken_off_as_it_begins(seed, human):
    keeps_laws(seed, human, troubles=True)


@pytest.mark.slow
def test_they_keep_every_law_where_work_is_broken_off_as_it_begins_on_many_floors():
    found = [keeps_laws(seed, human, troubles=True) > 2 for seed in range(100, 120) for human in (ALL, NO_STATE_PACE)]
    assert sum(found) > 25
