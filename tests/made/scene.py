"""Scenes of shipped scenarios, a little while of each, made once."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

from plans import loaded as loaded_text

from opsim.engine.floor.run import run_plan
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.shipped import find_scenario
from opsim.viewer.build import scene_of
from opsim.viewer.write import packed
from tests.bench.full_shift import full_shift

SECONDS = {
    "walking_cell": 600.0, "two_shift_plant": 7200.0, "kitting": 250.0, "repack_cell": 2400.0,
    "eight_station_cell": 900.0,
}  # fmt: skip
SHIFT = "a made shift"
"""Six people, eight minutes."""
SHOWN = (*SECONDS, SHIFT)


def opened(loaded, horizon_s=None):
    """What ``reopened`` gives of a run, without a folder."""
    plan = compile_plan(loaded)
    if horizon_s is not None:
        plan = replace(plan, horizon_s=horizon_s, warm_up_s=0.0)
    log = run_plan(plan)
    result = SimpleNamespace(summary={"variant": "base"})
    return SimpleNamespace(log=lambda replication=0: log, plan=plan, loaded=loaded, result=result)


def opened_text(text):
    return opened(loaded_text(text))


@cache
def run_of(name, horizon_s=None):
    if name == SHIFT:
        return opened_text(full_shift(6, 6, "8 min", replications=1).replace("warm_up: 30 min, ", ""))
    loaded = read_scenarios(find_scenario(name))["base"]
    return opened(loaded, SECONDS.get(name, 1200.0) if horizon_s is None else horizon_s)


@cache
def scene(name):
    return scene_of(run_of(name), scores=False)


@cache
def packed_scene(name):
    return packed(scene(name))
