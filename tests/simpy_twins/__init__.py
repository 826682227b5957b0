"""Small floors as plain SimPy, each a few processes, and the scenario that says the same; they know no engine."""

from collections.abc import Callable
from typing import NamedTuple

from simpy_twins import flow, machines, people
from simpy_twins.floor import Floor


class Twin(NamedTuple):
    """A scenario as text, what builds the same floor by hand, and the kinds (with causes) of rows it is there for."""

    text: str
    build: Callable[[Floor], None]
    shows: tuple[str, ...]


TWINS = {
    "M/M/c": Twin(flow.QUEUE, flow.queue, ("queue", "work", "wait idle")),
    "blocking line": Twin(flow.LINE, flow.line, ("blocked", "queue", "wait idle")),
    "kanban": Twin(flow.KANBAN, flow.kanban, ("held card", "blocked card", "queue")),
    "rework": Twin(flow.REWORK, flow.rework, ("rework bad", "rework false_alarm", "scrap bad", "finish bad")),
    "breakdown": Twin(machines.BREAKDOWNS, machines.breakdowns, ("down breakdown", "repair breakdown", "held down")),
    "conveyor": Twin(machines.CONVEYOR, machines.conveyor, ("transport", "queue", "blocked")),
    "transporter": Twin(
        machines.TRANSPORTER, machines.transporter, ("transport pickup", "transport idle", "held pickup")
    ),
    "pre-emption": Twin(machines.PREEMPTION, machines.preemption, ("queue preempted", "queue", "work")),
    "shift change": Twin(people.SHIFTS, people.shifts, ("off", "held worker", "wait idle")),
    "team": Twin(people.TEAM, people.team, ("held team", "wait team", "walk")),
    "two skills": Twin(people.SKILLS, people.skills, ("held worker", "queue", "wait idle")),
    "walking worker": Twin(people.WALKS, people.walks, ("walk", "held worker", "wait idle")),
}
