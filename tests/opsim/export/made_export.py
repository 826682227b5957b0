"""Small runs whose logs have rows of many kinds, for tests of what is made of them."""

from functools import lru_cache

from opsim.engine.floor.run import run_plan
from opsim.export.ocel import object_log
from opsim.export.tables import RunClock
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.scenario.read import scenarios_in

SHOP = """
opsim: 1
name: Shop
run: {horizon: 20 min, seed: 3, start: Tue 06:00}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
tasks:
  cut: {fixed: 20 s}
  drill: {fixed: 25 s}
stations:
  saw: {at: here, tasks: [cut], buffer: 2}
  press: {at: there, tasks: [drill], buffer: 2}
products: {part: {share: 0.5, route: [saw, press], due: 10 min}, plate: {share: 0.5, route: [press]}}
release: {kind: schedule, file: orders.csv}
workers: {ana: {skills: {saw: 1.0, press: 1.0}, height: 1.62 m}}
"""
ORDERS = "time,product,quantity,due\n0,part,2,\n60,plate,1,400\n90,part,1,\n"


@lru_cache
def ran(name, horizon="40 min"):
    """(log, plan) of a shipped scenario, shortened."""
    changes = {"run.horizon": horizon, "run.warm_up": "0 s"}
    plan = compile_plan(next(iter(read_scenarios(name, changes=changes).values())), seed=1)
    return run_plan(plan, 0), plan


def shop(folder):
    """(log, plan) of a shop whose jobs come by orders."""
    (folder / "orders.csv").write_text(ORDERS)
    plan = compile_plan(scenarios_in(SHOP.encode(), folder / "shop.yaml")["base"])
    return run_plan(plan, 0), plan


def made(log, plan, **how):
    """Its object-centric log."""
    return object_log(log, plan, RunClock(plan.start_s), **how)


MANY = ("pump_plant", "assembly", "two_shift_plant")
"""Scenarios with tools, vehicles, stores, splits, stops, rework, breaks and hours between them."""
