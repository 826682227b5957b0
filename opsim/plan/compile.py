"""Scenario -> Plan.

Where on its way a job has a card of a loop.

Where the ways of products end: out of the floor, in a store, or in the pieces they are split into.

The rule that evens out exposure: where a plan has it, the engine counts what each body has gone through so far.
"""

from __future__ import annotations

from collections.abc import Sequence

from opsim.layout import distances_m
from opsim.plan.plan import Plan
from opsim.plan.ranks import ranks_of
from opsim.plan.subjects import plan_subjects
from opsim.subjects.breakdowns.plan import plan_breakdowns, plan_maintenance, plan_repair_teams, repair_tasks
from opsim.subjects.exposure.plan import plan_ergonomics
from opsim.subjects.human.plan import plan_human
from opsim.subjects.lines.plan import plan_crews, plan_lines, plan_shares
from opsim.subjects.material.plan import CardPlan, plan_assembly, plan_cards
from opsim.subjects.people.plan import plan_rotations, plan_walking, plan_workers
from opsim.subjects.quality.plan import plan_quality, with_detours
from opsim.subjects.release.plan import plan_sources
from opsim.subjects.routes.plan import ProductPlan, plan_products
from opsim.subjects.sequencing.plan import (
    has_priorities,
    looks_ahead,
    plan_queues,
    plan_setups,
    setup_tasks,
    work_ahead,
)
from opsim.subjects.shifts.plan import plan_shifts
from opsim.subjects.stations.plan import STORE, plan_stations
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


def has_card(card: CardPlan, rank: int, plan: Plan, points: Sequence[int]) -> list[bool]:
    """(rows,) whether a job of a product had a card in each of its rows, from the points it was at in turn.

    Of a plain route the steps are told apart; else a card is taken wherever one ever is taken. What lies in a store at
    the start has a card of a loop that ends there, or on the way out. Where the loop may have ended at a station that
    is only passed, and leaves no row, the job has none.
    """
    product = plan.products[rank]
    steps, has, before, at = set(card.steps[rank]), False, -1, -1
    taken = {point for step in steps for point in product.route[step].stations}
    first = {point for _, step in product.start for point in product.route[step].stations}
    ends = {point for point in card.back if plan.stations[point].kind == "station" and not plan.stations[point].tasks}
    in_a_row = all(ways == ((1.0, step + 1),) for step, ways in enumerate(product.onward[:-1]))
    found = []
    for point in points:
        if point != before:
            came, at = at, _next_step(product, at, point) if in_a_row else -1
            enters = at in steps if at >= 0 else point in taken
            in_stock = bool(steps) and before < 0 and point in (card.back or (point,)) and point not in first
            left = before in card.back or _may_have_passed(product, ends, came, at)
            has = (has and not left) or enters or in_stock
            before = point
        found.append(has)
    return found


def _may_have_passed(product: ProductPlan, ends: set[int], came: int, at: int) -> bool:
    """Whether a job may have been at one of some points between two steps of its route; -1: at any step."""
    between = product.route[came + 1 : at] if min(came, at) >= 0 else product.route
    return bool(ends) and any(ends.intersection(operation.stations) for operation in between)


def _next_step(product: ProductPlan, at: int, point: int) -> int:
    """The first step after another at which a job can be at a point; -1 where there is none."""
    later = range(at + 1, len(product.route))
    return next((step for step in later if point in product.route[step].stations), -1)


def finishes(plan: Plan, product: int) -> bool:
    """Whether jobs of a product can leave the floor as something finished."""
    apart = {split.station for split in plan.splits if split.product == product}
    return any(plan.stations[rank].kind != STORE and rank not in apart for rank in _last_points(plan, product))


def stores_of(plan: Plan, product: int) -> list[int]:
    """The stores in which the ways of a product end, by rank."""
    return sorted(rank for rank in _last_points(plan, product) if plan.stations[rank].kind == STORE)


def _last_points(plan: Plan, product: int) -> set[int]:
    made = plan.products[product]
    ends = (step for step, onward in zip(made.route, made.onward) if any(to < 0 for _, to in onward))
    return {rank for step in ends for rank in step.stations}


LEAST_EXPOSED = "least_exposed"
"""Its name, among the rules of allocation and among those of rotations."""


def evens_out(plan: Plan) -> bool:
    """Whether any rule of a plan asks who is the least exposed."""
    return LEAST_EXPOSED in (plan.rule, *(rotation.rule for rotation in plan.rotations))
