"""Random scenarios: every law holds, and the order of declaration decides nothing even where times tie.

Random scenarios over the whole language: every law holds, and the order of declaration decides nothing.

A block is told of by a scenario where at least 20 jobs finished, two performances ended at one instant, and the log
shows what the block does.

Random paced lines with everything that a station of one may have: laws hold, and the order of declaration decides
nothing.
"""

from __future__ import annotations

import random
import re
from collections import Counter
from collections.abc import Callable
from functools import partial
from random import Random

import numpy as np
import pytest
import yaml
from checked_floors import checked
from choices import Drawn, Lots
from hypothesis import given, settings
from hypothesis import strategies as st
from made.blocks import BLOCKS, floor_with
from made.lines import line_scenario
from plans import plan

from opsim import log as kinds
from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.kpi.table import figures as figures_of
from opsim.laws.audit import CHECKS, audit
from opsim.log import COLUMNS, FINISH, JOB_KINDS, SENT_ON, STANDS, WORK, EventLog
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

WORK_AT = ("t{0}", "m, t{0}", "t{0}, m", "m, t{0}, m")
RELEASES = ("{kind: saturated}", "{kind: poisson, every: 3 s}", "{kind: poisson, every: 3 s, when_full: lose}")


def floor(pick) -> dict:
    """A scenario as blocks of lines, with whole-second times so that ties are real."""
    n_stations, n_workers = pick.whole(1, 4), pick.whole(1, 4)
    way = pick.one_of(["series", "parallel", "again", "drawn"])
    room = 9 if way == "drawn" else 2  # where jobs come back, small buffers lock the floor soon
    automatic = pick.one_of(["true", "false", "false"])
    tasks = [
        f"t{i}: {{fixed: {pick.whole(1, 4)} s, repeat: {pick.whole(1, 2)}, automatic: {automatic}}}"
        for i in range(n_stations)
    ]
    stations = [
        f"s{i}: {{at: p{pick.whole(0, 2)}, tasks: [{pick.one_of(WORK_AT).format(i)}], "
        f"servers: {pick.whole(1, 2)}, buffer: {pick.whole(0, room)}}}"
        for i in range(n_stations)
    ]
    routes = [[f"s{i}" for i in pick.shuffled(range(n_stations))] for _ in range(pick.whole(1, 2))]
    idle, carried = pick.one_of(["stay", "home", "patrol"]), pick.one_of(["false", "false", "true"])
    return {
        "tasks": [*tasks, "m: {fixed: 2 s}"],
        "stations": stations,
        "products": [
            f"q{r}: {{share: {1 / len(routes)}, carried: {carried}, {way_of(names, way)}}}"
            for r, names in enumerate(routes)
        ],
        "workers": [worker(pick, i, n_stations, idle == "patrol") for i in range(n_workers)],
        "release": pick.one_of(RELEASES),
        "rule": pick.one_of(["longest_queue", "nearest", "oldest_job"]),
        "blocked": pick.one_of(["free", "held"]),
        "idle": idle,
    }


def worker(pick, number: int, n_stations: int, patrols: bool) -> str:
    skilled = [f"s{j}" for j in range(n_stations) if number == 0 or (patrols and j == 0) or pick.whole(0, 1)]
    round_ = f"patrol: [{', '.join(pick.shuffled(skilled))}], " if patrols else ""
    skills = ", ".join(f"{name}: 1.0" for name in skilled)
    return f"w{number}: {{walk: {pick.whole(1, 2)} m/s, {round_}skills: {{{skills}}}}}"


def way_of(names: list[str], way: str) -> str:
    """A product's way through its stations: in series, the first two in parallel, one twice in a row, or drawn."""
    if way == "drawn":
        onward = [*names[1:], "out"]
        rows = [f"{name}: {{{names[0]}: 0.25, {then}: 0.75}}" for name, then in zip(names[1:], onward[1:])]
        first = f"{names[0]}: {{{names[0]}: 0.25, {onward[0]}: 0.75}}"
        return f"routing: {{start: {names[0]}, {', '.join([first, *rows])}}}"
    steps = [f"[{names[0]}, {names[1]}]", *names[2:]] if way == "parallel" and len(names) > 2 else names
    return f"route: [{', '.join([names[0], *names] if way == 'again' else steps)}]"


def text_of(blocks: dict, order: random.Random | None = None) -> str:
    lines = ["opsim: 1", "name: random", "run: {horizon: 400 s, warm_up: 20 s, seed: 3}"]
    lines.append("layout: {places: {p0: [0 m, 0 m], p1: [3 m, 0 m], p2: [3 m, 4 m]}}")
    for block in ("tasks", "stations", "products", "workers"):
        entries = list(blocks[block])
        if order is not None:
            order.shuffle(entries)
        lines += [f"{block}:", *(f"  {entry}" for entry in entries)]
    lines.append(f"release: {blocks['release']}")
    lines.append(f"allocation: {{rule: {blocks['rule']}, when_blocked: {blocks['blocked']}, idle: {blocks['idle']}}}")
    return "\n".join(lines)


FEATURES = {
    "routing drawn": "routing:",
    "a station twice": r"route: \[(s\d), \1",
    "parallel stations": r"route: \[\[",
    "idle home": "idle: home",
    "idle patrol": "idle: patrol",
    "held when blocked": "when_blocked: held",
    "lost when full": "when_full: lose",
    "automatic tasks": "automatic: true",
    "carried": "carried: true",
    "saturated": "kind: saturated",
    "several servers": "servers: 2",
    "nearest": "rule: nearest",
    "oldest_job": "rule: oldest_job",
}


def is_telling(log) -> bool:
    """At least 20 jobs finished, and two performances ended at one instant."""
    whole = log.where((log["kind"] == WORK) & (log["progress_to"] == 1))
    return len(log.of(FINISH)) >= 20 and np.unique(whole["end_s"]).size < len(whole)


def check(blocks: dict, shuffle: int) -> list[str]:
    """The features that a scenario tells something about, once its laws hold and its order has decided nothing."""
    text = text_of(blocks)
    p = plan(text)
    log = run_plan(p)
    assert audit(log, p) == CHECKS
    assert all(np.isnan(f.value) or f.value >= -1e-9 for f in figures(log, p))
    again = run_plan(plan(text_of(blocks, random.Random(shuffle))))
    assert again.names == log.names
    assert all(np.array_equal(again[c], log[c], equal_nan=log[c].dtype.kind == "f") for c in COLUMNS)
    return [feature for feature, word in FEATURES.items() if re.search(word, text)] if is_telling(log) else []


@settings(max_examples=60, deadline=None)
@given(st.data(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing(data, shuffle):
    check(floor(Drawn(data.draw)), shuffle)


@pytest.mark.slow
def test_every_feature_is_told_of_by_25_of_700_scenarios():
    seen = Counter(feature for seed in range(700) for feature in check(floor(Lots(seed)), seed))
    assert {feature: seen[feature] for feature in FEATURES if seen[feature] < 25} == {}


MOST_BLOCKS = 7
ENOUGH = 25
SELDOM = (
    *(
        "choice",
        "choice",
        "sequence",
        "schedule",
        "at_once",
        "kanban",
        "buffer_after",
        "quality",
        "conveyor",
        "conveyor",
    ),
    *("blocking_before", "setup", "fixtures", "task_tools", "priorities"),
)


def chosen(pick) -> list[str]:
    """Three to seven blocks, those that seldom find room twice as often."""
    return list(dict.fromkeys(pick.shuffled([*BLOCKS, *SELDOM])))[: pick.whole(3, MOST_BLOCKS)]


def blocks_keep_laws(values: dict, wanted: list[str], shuffle: int) -> list[str]:
    """The blocks that a scenario tells something about, once what holds of any floor has held."""
    log, _ = checked(values, shuffle)
    return [name for name in wanted if told(name, values, log)] if tells_of_blocks(log) else []


def tells_of_blocks(log: EventLog) -> bool:
    """At least 20 jobs finished, and two performances ended at one instant."""
    whole = log.where((log["kind"] == kinds.WORK) & (log["progress_to"] == 1))
    return len(log.of(kinds.FINISH)) >= 20 and np.unique(whole["end_s"]).size < len(whole)


def _has_key(values: dict, section: str, key: str) -> bool:
    return any(key in entry for entry in values.get(section, {}).values())


def _rows(log: EventLog, kind: int, cause: int | None = None) -> bool:
    rows = log.of(kind)
    return bool(len(rows)) and (cause is None or bool(np.any(rows["cause"] == cause)))


def _caused(log: EventLog, cause: int) -> bool:
    return bool(np.any(log["cause"] == cause))


def _in_section(section: str, key: str) -> Callable[[dict, EventLog], bool]:
    return lambda values, _log: _has_key(values, section, key)


def _seen(what: Callable[..., bool], *wanted: int) -> Callable[[dict, EventLog], bool]:
    return lambda _values, log: what(log, *wanted)


TOLD: dict[str, Callable[[dict, EventLog], bool]] = {
    "choice": lambda values, _: "routing" in values.get("flow", {}),
    "passed": lambda values, _: "x0" in values["stations"],
    "schedule": lambda values, _: values.get("sources", {}).get("main", {}).get("kind") == "schedule",
    "sequence": lambda values, _: "sequence" in values.get("sources", {}).get("main", {}),
    "at_once": lambda values, _: (
        "at_once" in {**values.get("release", {}), **values.get("sources", {}).get("main", {})}
    ),
    "several_sources": lambda _, log: np.unique(log.of(kinds.FINISH)["source"]).size > 1,
    "conwip": _seen(_caused, kinds.NO_CARD),
    "kanban": _seen(_caused, kinds.NO_CARD),
    "assembly": _seen(_rows, kinds.JOIN),
    "split": _seen(_rows, kinds.SPLIT),
    "lots": _in_section("products", "lot"),
    "batch": _seen(_caused, kinds.BATCH),
    "buffer_after": _seen(_caused, kinds.AFTER),
    "blocking_before": _seen(_caused, kinds.NO_PLACE),
    "queue_rule": _in_section("stations", "dispatch"),
    "priorities": _in_section("products", "priority"),
    "setup": _seen(_rows, kinds.SETUP),
    "fixtures": _seen(_caused, kinds.NO_TOOL),
    "task_tools": _seen(_caused, kinds.NO_TOOL),
    "breakdowns": _seen(_caused, kinds.BREAKDOWN),
    "maintenance": _seen(_caused, kinds.MAINTENANCE),
    "quality": lambda _, log: _rows(log, kinds.SCRAP) or _rows(log, kinds.REWORK),
    "teams": _seen(_caused, kinds.TEAM),
    "attended": _in_section("tasks", "automatic"),
    "conveyor": lambda values, log: "belt" in values.get("conveyors", {}) and _rows(log, kinds.TRANSPORT),
    "transporter": lambda values, log: "truck" in values.get("transporters", {}) and _rows(log, kinds.TRANSPORT),
    "carrying": _seen(_rows, kinds.TRANSPORT),
}


def told(name: str, values: dict, log: EventLog) -> bool:
    """Whether a block shows in the log or, where it only says when or which, stands in the scenario."""
    return TOLD[name](values, log)


def told_by(seed: int, wanted: Callable[..., list[str]] = chosen) -> list[str]:
    pick = Lots(seed)
    blocks = wanted(pick)
    return blocks_keep_laws(floor_with(pick, blocks), blocks, seed)


@settings(max_examples=40, deadline=None)
@given(st.data(), st.integers(0, 100))
def test_laws_hold_and_declaration_order_decides_nothing_with_every_block(data, shuffle):
    pick = Drawn(data.draw)
    blocks = chosen(pick)
    blocks_keep_laws(floor_with(pick, blocks), blocks, shuffle)


@pytest.mark.slow
def test_every_block_is_told_of_by_25_of_500_random_scenarios():
    seen = Counter(block for seed in range(500) for block in told_by(seed))
    assert {block: seen[block] for block in BLOCKS if seen[block] < ENOUGH} == {}


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))])
@pytest.mark.parametrize("block", list(BLOCKS))
def test_each_block_alone_keeps_the_laws(block, seed):
    told_by(seed, partial(lambda name, _pick: [name], block))


SECTIONS = ("tasks", "stations", "products", "sources", "workers", "shifts", "tools")


def planned(values, folder):
    text = yaml.safe_dump(values, sort_keys=False)
    return compile_plan(scenarios_in(text.encode(), folder / "line.yaml")["base"])


def shuffled(values, seed):
    pick, found = Random(seed), dict(values)
    for section in SECTIONS:
        names = list(values.get(section, {}))
        pick.shuffle(names)
        found |= {section: {name: values[section][name] for name in names}} if names else {}
    return found


def checked_line(seed, folder):
    values = line_scenario(seed)
    p = planned(values, folder)
    log = run_plan(p)
    assert audit(log, p) == CHECKS, seed
    assert all(not figure.value < -1e-9 for figure in figures_of(log, p)), seed
    again = run_plan(planned(shuffled(values, seed), folder))
    assert len(log) == len(again), seed
    assert all(np.array_equal(log[c], again[c], equal_nan=log[c].dtype.kind == "f") for c in COLUMNS), seed
    return log, p


def apart_s(log, p):
    """The least time between two jobs coming onto the line."""
    (line,) = p.lines
    here = np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] == line.stations[0])
    rows = log.where(here)
    first = [rows["start_s"][rows["job"] == job].min() for job in np.unique(rows["job"])]
    return np.diff(np.sort(first)).min(initial=np.inf)


@pytest.mark.parametrize("seed", range(8))
def test_a_few_random_lines_obey_the_laws(seed, tmp_path):
    log, p = checked_line(seed, tmp_path)
    assert apart_s(log, p) >= p.lines[0].takt_s


@pytest.mark.slow
def test_random_lines_obey_the_laws_and_show_what_lines_do(tmp_path):
    seen: Counter[str] = Counter()
    for seed in range(8, 300):
        log, p = checked_line(seed, tmp_path)
        (line,) = p.lines
        assert apart_s(log, p) >= line.takt_s, seed
        seen.update({f"{line.kind} {'sends on' if line.sends_on else 'stops'}"} if len(log.of(FINISH)) > 3 else ())
        seen.update({"sent on"} if len(log.of(SENT_ON)) else ())
        seen.update({f"stands: {log.names['cause'][cause]}" for cause in np.unique(log.of(STANDS)["cause"])})
        called = np.isin(log["worker"], line.floaters) & (log["task"] >= 0)
        seen.update({f"helps {line.helps}"} if np.any(called) else ())
    wanted = [f"{kind} {what}" for kind in ("indexed", "moving") for what in ("sends on", "stops")]
    wanted += [f"stands: {cause}" for cause in ("unfinished", "full", "down", "closed", "away")]
    wanted += ["sent on", "helps True", "helps False"]
    assert {name: seen[name] for name in wanted if seen[name] < 10} == {}
