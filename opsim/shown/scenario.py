"""A scenario in a notebook: who works where on what."""

from __future__ import annotations

from typing import Any

from opsim.shown.html import count, duration, sentence, table


def scenario_html(scenario: Any, variant: str = "") -> str:
    """A sentence, the stations with their tasks, and the products with their routes."""
    run = scenario.run
    of = f", variant {variant}" if variant else ""
    words = (
        f"{scenario.name}{of}: {_counts(scenario.stations, scenario.workers, scenario.products)}; "
        f"{duration(run.horizon_s)} from {run.start} on, {count(run.replications, 'replication')}."
    )
    stations = [(name, one.at, one.servers, ", ".join(one.tasks)) for name, one in scenario.stations.items()]
    return sentence("Scenario:", words) + table(("station", "at", "servers", "tasks"), stations)


def plan_html(plan: Any) -> str:
    """The same of a Plan: names for the numbers."""
    words = (
        f"{plan.name}: {_counts(plan.stations, plan.workers, plan.products)}; "
        f"{duration(plan.horizon_s)}, seed {plan.seed}."
    )
    stations = [
        (
            one.name,
            one.kind,
            plan.places[one.place],
            one.servers,
            ", ".join(plan.tasks[task].name for task in one.tasks),
        )
        for one in plan.stations
    ]
    return sentence("Plan:", words) + table(("point of the flow", "kind", "at", "servers", "tasks"), stations)


def _counts(stations: Any, workers: Any, products: Any) -> str:
    return f"{count(len(stations), 'station')}, {count(len(workers), 'worker')}, {count(len(products), 'product')}"
