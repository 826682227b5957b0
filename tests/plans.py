"""Small scenarios as text -> Plans, for tests."""

from pathlib import Path

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import EventLog
from opsim.plan import Plan, compile_plan
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.scenario.schema.scenario import Loaded

HERE = Path(__file__).parent


def loaded(text: str, variant: str = "base") -> Loaded:
    return scenarios_in(text.encode(), HERE / "test.yaml")[variant]


def plan(text: str) -> Plan:
    return compile_plan(loaded(text))


def ran(text: str, *edits: tuple[str, str]) -> tuple[EventLog, Plan]:
    """The log of a scenario with some of its words replaced, and its plan; the log obeys all laws."""
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    made = plan(text)
    log = run_plan(made)
    audit(log, made)
    return log, made


def answer(text: str, *edits: tuple[str, str]) -> str:
    """What is said of a scenario in which some words, each there once, are replaced; "good" where nothing is wrong."""
    for old, new in edits:
        assert text.count(old) == 1, (old, text.count(old))
        text = text.replace(old, new)
    try:
        scenarios_in(text.encode(), Path("line.yaml"))
    except ScenarioError as error:
        return str(error)
    return "good"


def line(
    n_stations: int, buffer: int, *, horizon: str, warm_up: str = "1000 s", seed: int = 1, mean: str = "1 s"
) -> str:
    """A saturated line of exponential stations, a worker each, ``buffer`` places between them."""
    ranks = range(1, n_stations + 1)
    stations = [f"  s{i}: {{at: p{i}, tasks: [t{i}], buffer: {1 if i == 1 else buffer}}}" for i in ranks]
    return "\n".join(
        [
            "opsim: 1",
            "name: line",
            f"run: {{horizon: {horizon}, warm_up: {warm_up}, seed: {seed}}}",
            "layout: {places: {" + ", ".join(f"p{i}: [{i} m, 0 m]" for i in ranks) + "}}",
            "tasks: {" + ", ".join(f"t{i}: {{dist: exponential, mean: {mean}}}" for i in ranks) + "}",
            "stations:",
            *stations,
            "products: {part: {route: [" + ", ".join(f"s{i}" for i in ranks) + "]}}",
            "release: {kind: saturated}",
            "workers: {" + ", ".join(f"w{i}: {{skills: {{s{i}: 1.0}}}}" for i in ranks) + "}",
        ]
    )


def queue(
    *, horizon: str, servers: int = 1, warm_up: str = "1000 s", every: str = "1.25 s", mean: str = "1 s", seed: int = 1
) -> str:
    """M/M/c with a worker for each server."""
    workers = ", ".join(f"w{i}: {{skills: {{counter: 1.0}}}}" for i in range(1, servers + 1))
    return f"""
opsim: 1
name: queue
run: {{horizon: {horizon}, warm_up: {warm_up}, seed: {seed}}}
layout: {{places: {{counter: [0 m, 0 m]}}}}
tasks: {{serve: {{dist: exponential, mean: {mean}}}}}
stations: {{counter: {{at: counter, tasks: [serve], servers: {servers}}}}}
products: {{customer: {{route: [counter]}}}}
release: {{kind: poisson, every: {every}}}
workers: {{{workers}}}
allocation: {{rule: oldest_job}}
"""


CELL = """
opsim: 1
name: cell
run: {horizon: 2 h, warm_up: 10 min, replications: 3, seed: 5}
layout:
  distance: rectilinear
  places: {inbound: [0 m, 0 m], bench: [4 m, 1 m], press: [7 m, 2 m], rack: [9 m, 1 m]}
tasks:
  lift:  {dist: lognormal, mean: 12 s, cv: 0.3, between_share: 0.4}
  label: {dist: gamma, mean: 20 s, cv: 0.25, repeat: 2}
  press: {fixed: 30 s, automatic: true}
  stow:  {dist: uniform, low: 5 s, high: 15 s}
stations:
  unload:  {at: inbound, tasks: [lift], buffer: 3}
  repack1: {at: bench, servers: 2, tasks: [label, press, stow], buffer: 1}
  repack2: {at: press, tasks: [label], buffer: 0}
  store:   {at: rack, tasks: [stow], buffer: 2}
products:
  carton: {share: 0.7, route: [unload, [repack1, repack2], store]}
  crate:  {share: 0.3, route: [unload, store]}
release: {kind: poisson, every: 40 s, when_full: lose}
workers:
  ana: {skills: {unload: 1.0, repack1: 1.1}}
  ben: {walk: 1 m/s, skills: {store: 1.0, repack1: 0.9, repack2: 1.0}}
  cai: {skills: {repack2: 1.2, unload: 0.8, store: 0.7}, home: rack}
allocation: {rule: nearest, when_blocked: held}
"""
"""Everything the vocabulary has, in one small scenario."""


def many_stations(n):
    """A scenario of some 8 n lines, one of its variants an override away."""
    ranks = range(n)
    return "\n".join(
        [
            "opsim: 1",
            "name: Many stations",
            "run: {horizon: 8 h}",
            "layout:",
            "  places:",
            *(f"    p{i}: [{i} m, {i % 7} m]" for i in ranks),
            "tasks:",
            *(f"  t{i}: {{dist: lognormal, mean: {10 + i % 20} s, cv: 0.25, between_share: 0.5}}" for i in ranks),
            "stations:",
            *(f"  s{i}:\n    at: p{i}\n    tasks: [t{i}]\n    servers: 1\n    buffer: 3" for i in ranks),
            "products:",
            "  part: {route: [" + ", ".join(f"s{i}" for i in ranks) + "]}",
            "release: {kind: poisson, every: 55 s}",
            "workers:",
            *(f"  w{i}: {{skills: {{s{i}: 1.0, s{(i + 1) % n}: 0.9}}}}" for i in ranks),
            "overrides: {wider: {stations.s1.buffer: 9}}",
            "scenarios: {base: [], wide: [wider]}",
        ]
    )
