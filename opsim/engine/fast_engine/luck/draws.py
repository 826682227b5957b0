"""All luck of a replication, by name: the streams of ``engine/draws.py``, in arrays of many blocks."""

from __future__ import annotations

from opsim.engine.fast_engine.luck.blocks import HeldStream, Stream, uniforms
from opsim.engine.fast_engine.luck.of_plan import luck_of
from opsim.plan import BreakdownPlan, MaintenancePlan, Plan
from opsim.plan.tools import HoldPlan
from opsim.task import TaskModel


class BlockDraws:
    """The named streams of one replication. To make one costs a few us, as does each stream."""

    __slots__ = ("_luck", "_plan", "begun", "workforce")

    def __init__(self, plan: Plan, replication: int):
        self._plan, self._luck = plan, luck_of(plan)
        self.begun = self._luck.begun(replication)
        self.workforce = plan.workforce_of(replication)

    def durations(self, task: int, worker: int) -> Stream:
        """All performances of a task by a worker, at skill rating 1."""
        return Stream(self._key(self._of_worker(task, worker)), self._luck.of_worker(task, worker, self.workforce))

    def durations_with(self, hold: HoldPlan, task: int, worker: int) -> HeldStream:
        """``durations``, each with the moments between which a tool is held."""
        drawn = self._luck.held_by_worker(hold, task, worker, self.workforce)
        return HeldStream(self._key(self._of_worker(task, worker)), drawn)

    def automatic_runs(self, task: int, station: int) -> Stream:
        """All automatic runs of a task at a station."""
        return Stream(self._key(self._at_station(task, station)), self._luck.of_model(self._plan.tasks[task].model))

    def runs_with(self, hold: HoldPlan, task: int, station: int) -> HeldStream:
        """``automatic_runs``, each with the moments between which a tool is held."""
        return HeldStream(self._key(self._at_station(task, station)), self._luck.held_by_station(hold, task))

    def gaps(self, source: int) -> Stream:
        """All gaps between the arrivals of a source."""
        return Stream(self._key(("interarrival", self._plan.sources[source].name)), self._luck.of_gaps(source))

    def products(self, source: int) -> Stream:
        """The ranks of the products that the jobs of a source are, int64."""
        return Stream(self._key(("mix", self._plan.sources[source].name)), self._luck.of_products(source))

    def repairs(self, stop: BreakdownPlan | MaintenancePlan) -> Stream:
        """How long each stop lasts."""
        return self.times(("repair", *self._stopped(stop)), self._plan.tasks[stop.task].model)

    def uptimes(self, stop: BreakdownPlan) -> Stream:
        """What lies between one breakdown and the next: seconds or cycles."""
        return self.times(("uptime", *self._stopped(stop)), stop.every)

    def ways(self, operation: str, visit: int, source: int) -> Stream:
        """In [0, 1): where the jobs of a source go after an operation they leave for the ``visit``-th time."""
        return self.chances(("routing", operation, self._plan.sources[source].name, visit))

    def chances(self, name: tuple[str | int, ...]) -> Stream:
        """In [0, 1), by the parts of a name."""
        return Stream(self._key(name), uniforms)

    def times(self, name: tuple[str | int, ...], model: TaskModel) -> Stream:
        """Durations of one of the Plan's models under the name of a stream."""
        return Stream(self._key(name), self._luck.of_model(model))

    def _key(self, name: tuple[str | int, ...]) -> bytes:
        return self.begun + self._luck.name(name)

    def _of_worker(self, task: int, worker: int) -> tuple[str, ...]:
        return "duration", self._plan.tasks[task].name, self._plan.workers[worker].name

    def _at_station(self, task: int, station: int) -> tuple[str, ...]:
        return "automatic", self._plan.tasks[task].name, self._plan.stations[station].name

    def _stopped(self, stop: BreakdownPlan | MaintenancePlan) -> tuple[str, str]:
        """The names of a station and of one of its stops, as parts of the name of a stream."""
        station = self._plan.stations[stop.station].name
        return station, stop.name.removeprefix(f"{station}: ")
