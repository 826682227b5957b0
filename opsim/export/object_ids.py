"""What the objects of a run are called: an id each, no two alike, whatever a scenario calls its people and places."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

from opsim.plan import Plan

WORKER, ORDER, TOOL, VEHICLE = "worker", "order", "tool", "vehicle"
"""Types of objects; beside them the kinds of ``StationPlan`` (station, store, conveyor), and ``job PRODUCT``."""


def job_type(product: str) -> str:
    """The type of the jobs of a product."""
    return f"job {product}"


@dataclass(frozen=True)
class ObjectIds:
    """Ids by rank and number. An id begins with the type, and ends with a number where several have one name."""

    plan: Plan

    @cached_property
    def workers(self) -> list[str]:
        return [f"{WORKER} {worker.name}" for worker in self.plan.workers]

    @cached_property
    def stations(self) -> list[str]:
        """Of all points of the flow: their names are of one kind of list, no two alike."""
        return [f"{point.kind} {point.name}" for point in self.plan.stations]

    @cached_property
    def tools(self) -> list[str]:
        return [f"{TOOL} {tool.name}" for tool in self.plan.tools]

    @cached_property
    def vehicles(self) -> list[str]:
        """Of each vehicle by its number: those of a transporter have its name, numbered from 1."""
        return [f"{VEHICLE} {pool.name} #{n + 1}" for pool in self.plan.transporters for n in range(pool.n)]

    def job(self, number: int) -> str:
        return f"job {number}"

    def order_of(self, job: int) -> tuple[int, int] | None:
        """(rank of its source, number of its order there) of a job; None where its source has no list of orders."""
        n, rank = divmod(job, len(self.plan.sources))
        firsts = self._firsts[rank]
        return (rank, bisect_right(firsts, n) - 1) if firsts else None

    def order(self, job: int) -> str | None:
        """The order that a job came from; orders of a source are numbered from 1, in its list's order."""
        found = self.order_of(job)
        return None if found is None else f"{ORDER} {self.plan.sources[found[0]].name} #{found[1] + 1}"

    @cached_property
    def _firsts(self) -> list[list[int]]:
        """Of each source, the number of the first job of each of its orders."""
        return [[order.first for order in source.orders] for source in self.plan.sources]
