"""Crews: bucket brigades and rabbit chases, whose members go with their jobs along a line."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor import crew as crew_steps
from opsim.engine.floor import crew_line
from opsim.engine.floor.machine import Handle
from opsim.engine.floor.parts.state import CREWS
from opsim.plan.crews import BUCKET_BRIGADE, CrewPlan

COMES, DONE = -10, 90
"""Among the preparations of a job the first; among what is asked when an operation is done the last."""


def install(build: Any) -> None:
    """The members of each crew are sent by it; that nobody else serves its stations is in their ratings."""
    if not build.plan.crews:
        return
    build.keep_jobs()
    crews = [_crew(build, plan) for plan in build.plan.crews]
    for rank in {rank for plan in build.plan.crews for rank in plan.workers}:
        build.restrict(build.workers[rank], CREWS, ())
    for number, (crew, plan) in enumerate(zip(crews, build.plan.crews)):
        for rank in plan.stations:
            build.hang(build.stations[rank].stages, crew_line.came, crew, COMES)
            build.hang(build.stations[rank].afters, crew_steps.done, crew, DONE)
        _guard(build, crew, plan, number)
        build.hang(build.floor.dispatchers, crew_steps.dispatch, crew)


def _crew(build: Any, plan: CrewPlan) -> Handle:
    crew, n = build.arena.new("Crew"), len(plan.workers)
    crew.is_brigade = plan.kind == BUCKET_BRIGADE
    crew.n_stations = len(plan.stations)
    crew.stations = build.arena.array("Station", [build.stations[rank] for rank in plan.stations])
    places = {rank: place for place, rank in enumerate(plan.stations)}
    crew.place = build.ints(places.get(rank, -1) for rank in range(len(build.stations)))
    gates = [gate for ranks, gate in build.gates.items() if not places.keys().isdisjoint(ranks)]
    crew.n_gates, crew.gates = len(gates), build.arena.array("Gate", gates)
    crew.n_members = n
    crew.members = build.arena.array("Worker", [build.workers[rank] for rank in plan.workers])
    crew.hand, crew.goal, crew.turn = build.ints([0] * n), build.ints([0] * n), build.ints([0] * n)
    crew.stand, crew.near = build.ints([-1] * n), build.floats([0.0] * n)
    return crew


def _guard(build: Any, crew: Handle, plan: CrewPlan, number: int) -> None:
    """Have every gate into the line keep the order too, where jobs may skip stations."""
    for ranks, gate in build.gates.items():
        first = min((place for place, rank in enumerate(plan.stations) if rank in ranks), default=-1)
        if first >= 0:
            guard = build.arena.new("CrewGate")
            guard.crew, guard.gate, guard.first_place = crew, gate, first
            build.hang(gate.allows, crew_line.stays_behind, guard, -1 - number)
            if gate.pick:
                guard.picked = gate.pick
                gate.pick = build.hook(crew_line.first_behind, guard)
    build.hang(build.floor.left_station, crew_line.stir_line, crew)
