"""Yamazumi: the work of a job stacked station by station, and of people, against takt."""

from __future__ import annotations

from collections.abc import Sequence

from opsim.report.material import Material
from opsim.report.section import Block, Bullets, Chart, Section
from opsim.report.yamazumi_figure import legend_of, looks_of, said_of, stack_figure
from opsim.report.yamazumi_stacks import Stack, station_stacks, worker_stacks
from opsim.report.yamazumi_words import person_sentences, station_sentences

MOST_ROWS = 30
HOW = (
    "Seconds of one visit of a job, over the station's servers (and over the jobs of a batch): the means of all "
    "replications, divided among tasks as in the first one. The whisker below a bar is P10 to P90 of the work of "
    "single visits, and goes on where it ends at the edge; set-up and walking are not in it."
)


def section(material: Material) -> Section | None:
    """Bars of stations and of people; None where there is no other station to compare with."""
    stacks = station_stacks(material) if material.plan.stations else []
    if len(stacks) < 2:
        return None
    shown = _most(stacks)
    more = (
        [f"{len(stacks) - len(shown)} more stations, with less work, are not drawn."]
        if len(shown) < len(stacks)
        else []
    )
    people = _people(material)
    blocks: list[Block] = [Bullets([*station_sentences(material, stacks), *more, *person_sentences(people)])]
    looks = looks_of(task for stack in shown for task in stack.tasks)
    chart = Chart(
        "yamazumi-stations", stack_figure(shown, looks), said_of(shown), "By station", legend_of(shown, looks), note=HOW
    )
    blocks.append(chart)
    blocks += _of_people(people)
    return Section("yamazumi", "Work against takt (Yamazumi)", blocks, "Yamazumi")


def _people(material: Material) -> list[Stack]:
    """Bars of workers, where who works where is not one and the same."""
    if material.log is None or len(material.plan.workers) < 2:
        return []
    stacks = worker_stacks(material.log, material.plan)
    tied = all(len(stack.tasks) == 1 and not stack.beside for stack in stacks)
    return [] if tied or len(stacks) < 2 else stacks


def _of_people(stacks: Sequence[Stack]) -> list[Block]:
    if not stacks:
        return []
    shown = _most(stacks)
    looks = looks_of(station for stack in shown for station in stack.tasks)
    note = "Seconds for each job that is finished while he is on duty, first replication."
    return [
        Chart(
            "yamazumi-people",
            stack_figure(shown, looks),
            said_of(shown),
            "By worker",
            legend_of(shown, looks),
            note=note,
        )
    ]


def _most(stacks: Sequence[Stack]) -> list[Stack]:
    """All in their order; of many those with most."""
    kept = sorted(stacks, key=lambda stack: -stack.total_s)[:MOST_ROWS]
    return [stack for stack in stacks if stack in kept]
