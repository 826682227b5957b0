"""Shipped and made scenarios with human effects on them, as plans."""

from dataclasses import replace
from pathlib import Path

from opsim.plan import Plan, compile_plan
from opsim.scenario.read import scenarios_in
from opsim.shipped import shipped_folder
from opsim.subjects.human.plan import NO_EFFECTS

NEUTRAL = """
human:
  learning: {model: wright, rate: 1, measured_at: 7}
  forgetting: {model: lfcm, forgotten_in: never, least_pause: 0 s}
  state_pace: {model: schultz, faster: 0, slower: 0}
  circadian: {amplitude: 0, peak: '03:00'}
  fatigue: {model: lffrm, slows: 0}
  errors: {at_full_fatigue: 0}
"""
LINE = """
opsim: 1
name: Line
run: {start: Mon 06:00, horizon: 4 h, seed: 5}
layout: {distance: euclidean, places: {one: [0 m, 0 m], two: [2 m, 0 m], three: [4 m, 0 m]}}
tasks:
  cut: {dist: lognormal, mean: 60 s, cv: 0.25}
  drill: {dist: lognormal, mean: 60 s, cv: 0.25}
  paint: {dist: lognormal, mean: 60 s, cv: 0.25}
stations:
  a: {at: one, tasks: [cut], buffer: 1}
  b: {at: two, tasks: [drill], buffer: 2}
  c: {at: three, tasks: [paint], buffer: 2}
products: {board: {route: [a, b, c]}}
release: {kind: saturated}
workers:
  ana: {skills: {a: 1.0}}
  ben: {skills: {b: 1.0}}
  cy: {skills: {c: 0.9}}
"""


def planned(text: str, human: str = "", *, path: Path | None = None) -> Plan:
    """The first scenario of a file's text, with effects behind it."""
    where = path or shipped_folder() / "made.yaml"
    return compile_plan(next(iter(scenarios_in(f"{text}\n{human}\n".encode(), where).values())))


def shipped(name: str, hours: float, human: str = "") -> Plan:
    """A shipped scenario for its first hours."""
    path = shipped_folder() / f"{name}.yaml"
    plan = planned(path.read_text(encoding="utf-8"), human, path=path)
    return replace(plan, horizon_s=min(plan.horizon_s, hours * 3600.0))


def without_effects(plan: Plan) -> Plan:
    """The same plan, of people to whom nothing happens."""
    return replace(plan, human=NO_EFFECTS)
