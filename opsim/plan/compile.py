"""Scenario -> Plan."""

from __future__ import annotations

from opsim.layout import distances_m
from opsim.plan.plan import Plan
from opsim.plan.ranks import ranks_of
from opsim.plan.subjects import plan_subjects
from opsim.subjects.breakdowns.plan import plan_breakdowns, plan_maintenance, plan_repair_teams, repair_tasks
from opsim.subjects.exposure.plan import plan_ergonomics
from opsim.subjects.human.plan import plan_human
from opsim.subjects.lines.plan import plan_crews, plan_lines, plan_shares
from opsim.subjects.material.plan import plan_assembly, plan_cards
from opsim.subjects.people.plan import plan_rotations, plan_walking, plan_workers
from opsim.subjects.quality.plan import plan_quality, with_detours
from opsim.subjects.release.plan import plan_sources
from opsim.subjects.routes.plan import plan_products
from opsim.subjects.sequencing.plan import (
    has_priorities,
    looks_ahead,
    plan_queues,
    plan_setups,
    setup_tasks,
    work_ahead,
)
from opsim.subjects.shifts.plan import plan_shifts
from opsim.subjects.stations.plan import plan_stations
from opsim.subjects.tasks.plan import plan_tasks
from opsim.subjects.tools.plan import plan_tools
from opsim.subjects.transport.plan import plan_conveyors, plan_transporters


def compile_plan(loaded, *, seed: int | None = None) -> Plan:
    """The Plan of a scenario that was read; ``seed`` replaces the file's own."""
    from opsim.tasks import task_model

    def model_of(task):
        return task_model(task, loaded)

    scenario = loaded.scenario
    tasks = plan_tasks(scenario, model_of, setup_tasks(scenario), repair_tasks(scenario, model_of))
    ranks = ranks_of(scenario, (task.name for task in tasks))
    stations, distance_m = plan_stations(scenario, ranks), distances_m(scenario.layout)
    products = with_detours(scenario, ranks, plan_products(scenario, ranks.stations))
    assembly = plan_assembly(scenario, ranks, plan_sources(loaded, ranks, model_of))
    queues = plan_queues(scenario, ranks, has_priorities(products, assembly.sources))
    looked_at = looks_ahead(queues, scenario.flow.routing, scenario.allocation.rule)
    together = {batch.station for batch in assembly.batches}
    return Plan(
        name=scenario.name,
        seed=scenario.run.seed if seed is None else seed,
        horizon_s=scenario.run.horizon_s,
        warm_up_s=scenario.run.warm_up_s,
        places=tuple(ranks.places),
        distance_m=distance_m,
        tasks=tasks,
        stations=stations,
        products=products,
        sources=assembly.sources,
        workers=plan_workers(scenario, ranks),
        rule=scenario.allocation.rule,
        when_blocked=scenario.allocation.when_blocked,
        idle=scenario.allocation.idle,
        staffing=scenario.run.staffing,
        across_tasks=scenario.run.across_tasks,
        walking=plan_walking(loaded),
        cards=plan_cards(scenario, ranks, products, assembly.sources),
        stores=assembly.stores,
        kits=assembly.kits,
        splits=assembly.splits,
        batches=assembly.batches,
        quality=plan_quality(scenario, ranks, products),
        tools=plan_tools(scenario),
        queues=queues,
        routing=scenario.flow.routing,
        setups=plan_setups(scenario, ranks, tasks),
        subjects=plan_subjects(scenario, ranks),
        ahead=work_ahead(stations, products, tasks, together) if looked_at else None,
        breakdowns=plan_breakdowns(scenario, ranks, model_of),
        maintenance=plan_maintenance(scenario, ranks),
        repair_teams=plan_repair_teams(scenario),
        conveyors=plan_conveyors(scenario, ranks),
        transporters=plan_transporters(scenario, ranks, distance_m),
        shifts=plan_shifts(scenario),
        crews=plan_crews(scenario, ranks),
        lines=plan_lines(scenario, ranks),
        rotations=plan_rotations(scenario, ranks),
        shares=plan_shares(scenario, ranks),
        priorities=tuple(scenario.allocation.priorities),
        serve=scenario.allocation.serve,
        ergonomics=plan_ergonomics(scenario),
        human=plan_human(scenario, ranks),
        posture=scenario.run.posture,
        start_s=scenario.run.start_s,
    )
