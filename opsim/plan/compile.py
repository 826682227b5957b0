"""Scenario -> Plan."""

from opsim.layout import distances_m
from opsim.plan.material import plan_products
from opsim.plan.plan import Plan
from opsim.plan.ranks import ranks_of
from opsim.plan.release import plan_sources
from opsim.plan.station import plan_stations
from opsim.plan.tasks import plan_tasks
from opsim.plan.walking import plan_walking
from opsim.plan.worker import plan_workers


def compile_plan(loaded, *, seed: int | None = None) -> Plan:
    """The Plan of a scenario that was read; ``seed`` replaces the file's own."""
    from opsim.tasks import task_model

    def model_of(task):
        return task_model(task, loaded)

    scenario = loaded.scenario
    ranks = ranks_of(scenario)
    return Plan(
        name=scenario.name,
        seed=scenario.run.seed if seed is None else seed,
        horizon_s=scenario.run.horizon_s,
        warm_up_s=scenario.run.warm_up_s,
        places=tuple(ranks.places),
        distance_m=distances_m(scenario.layout),
        tasks=plan_tasks(scenario, model_of),
        stations=plan_stations(scenario, ranks),
        products=plan_products(scenario, ranks.stations),
        sources=plan_sources(scenario, ranks, model_of),
        workers=plan_workers(scenario, ranks.places, ranks.stations),
        rule=scenario.allocation.rule,
        when_blocked=scenario.allocation.when_blocked,
        idle=scenario.allocation.idle,
        staffing=scenario.run.staffing,
        across_tasks=scenario.run.across_tasks,
        walking=plan_walking(loaded),
    )
