"""Plan -> the floor of a run, frozen before its first instant; each replication begins with that."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from typing import Any

from opsim.engine.floor import flow, settle
from opsim.engine.floor.floor_state import FIRST_ROTATION
from opsim.engine.floor.keys import have_room, use_rule
from opsim.engine.floor.machine import Arena, Handle, Step, line_of, step_of
from opsim.engine.rules import INTERRUPTION_RULES
from opsim.log import IDLE, IS_DOWN, WAIT
from opsim.plan import Plan
from opsim.plugins.registry import subjects_of
from opsim.subjects.breakdowns import failures
from opsim.subjects.human import human_effects
from opsim.subjects.lines import bucket_brigades, indexed_and_moving_lines, work_sharing
from opsim.subjects.material import assembly, cards, stores
from opsim.subjects.people import allocation, rotations
from opsim.subjects.quality import quality
from opsim.subjects.release import sources
from opsim.subjects.release.plan import POISSON, RENEWAL, SATURATED, SCHEDULE
from opsim.subjects.release.sources import BY_FLOOR, BY_ORDER, BY_TIME
from opsim.subjects.sequencing import sequencing, setups
from opsim.subjects.shifts import calendar, interruption
from opsim.subjects.shifts.plan import OPEN
from opsim.subjects.stations import batches, buffers
from opsim.subjects.tasks import levels
from opsim.subjects.tools import tools
from opsim.subjects.transport import conveyors, transporters

BLOCKS: tuple[Callable[[Any], None], ...] = (
    *(levels.install, allocation.install_preferences, stores.install),
    *(assembly.install_kits, assembly.install_splits, batches.install),
    *(setups.install, sequencing.install, buffers.install, cards.install, sources.install_base_stock, quality.install),
    *(work_sharing.install, tools.install, failures.install, interruption.install_preemption),
    *(calendar.install_opening_hours, conveyors.install, transporters.install, indexed_and_moving_lines.install),
    *(calendar.install_shifts, bucket_brigades.install, rotations.install, human_effects.install),
    allocation.install_doses,
)
"""What hangs in, in this order: each looks at its own part of the plan, and does nothing where that is empty."""
WHEN_IDLE = ("stay", "home", "patrol")
ALWAYS = (
    *(settle.start, settle.close, settle.report),
    *(settle.stretch_done, settle.automatic_done, flow.operation_done, sources.arrived, sources.ordered),
)
"""Steps that every floor needs, by way of its lines."""


class Build:
    """A floor that is being set up: ``floor`` and what it leads to are handles. steps : that its lines lead to.

    answers : what Python is asked in a run, besides numbers: each is told ``begin(numbers)`` as a replication begins
    """

    def __init__(self, plan: Plan):
        self.plan, self.arena = plan, Arena()
        self.steps: dict[int, Step] = {}
        self.floor = self.arena.new("Floor")
        self.names: dict[str, Any] = {}
        self.gates: dict[tuple[int, ...], Handle] = {}
        self.answers: list[Any] = []
        self._set_floor()
        self.outside = self.floor.outside = self._outside()
        self.tasks = [self._task(rank) for rank in range(len(plan.tasks))]
        self.stations = [self._station(rank) for rank in range(len(plan.stations))]
        self._add_gates()
        self.products = [self._product(rank) for rank in range(len(plan.products))]
        self.sources = [self._source(rank) for rank in range(len(plan.sources))]
        self.workers = [self._worker(rank) for rank in range(len(plan.workers))]
        self._put("Task", "tasks", self.tasks)
        self._put("Station", "stations", self.stations)
        self._put("Product", "products", self.products)
        self._put("Source", "sources", self.sources)
        self._put("Worker", "workers", self.workers)
        self._put("Gate", "gates", list(self.gates.values()))
        self.floor.saturated.extend(source for source in self.sources if plan.sources[source.rank].kind == SATURATED)
        self.floor.free.extend(self.workers)
        for call in ALWAYS:
            self.line(call)
        for install in BLOCKS:
            install(self)
        for subject, part in subjects_of(plan):
            subject.install(self, part)
        self._see_skills()

    def line(self, call: Any) -> Any:
        """The line of a step, which the floor needs from now on."""
        made = step_of(call)
        self.steps[made.line] = made
        return made.line

    def hook(self, call: Any, subject: Handle | None = None, order: int = 0) -> Handle:
        """A step with a subject, to be hung in."""
        made = self.arena.new("Hook")
        made.line, made.subject, made.order = self.line(call), subject, order
        return made

    def hang(self, hooks: Any, call: Any, subject: Handle | None = None, order: int = 0) -> None:
        """Put a hook into a list of them, by its order, behind those of the same."""
        others = [one.order for one in hooks]
        at = next((i for i, other in enumerate(others) if other > order), len(others))
        hooks.insert(at, self.hook(call, subject, order))

    def seat(self, station: Handle) -> None:
        """The jobs on the servers of a station have to be known."""
        station.has_seated = 1

    def keep_jobs(self) -> None:
        """Jobs have a JobBlocks; those that have left may still be referred to, and their memory is not used again."""
        self.floor.keeps_jobs = self.floor.has_job_blocks = 1

    def floats(self, values: Any) -> Any:
        return self.arena.array("float", values)

    def ints(self, values: Any) -> Any:
        return self.arena.array("int", values)

    def bits(self, ranks: Any) -> list[int]:
        """Ranks of stations as words of bits."""
        words = [0] * self.floor.n_words
        for rank in ranks:
            words[rank >> 6] |= 1 << (rank & 63)
        return [word - (1 << 64) if word >> 63 else word for word in words]

    def _put(self, struct: str, name: str, handles: list[Handle]) -> None:
        setattr(self.floor, f"n_{name}", len(handles))
        setattr(self.floor, name, self.arena.array(struct, handles))

    def _set_floor(self) -> None:
        plan, floor = self.plan, self.floor
        floor.memory = self.arena.memory
        floor.horizon_s = plan.horizon_s
        floor.n_stations, floor.n_tasks = len(plan.stations), len(plan.tasks)
        floor.n_places = len(plan.places)
        floor.distance_m = self.floats(metres for row in plan.distance_m for metres in row)
        floor.n_words = -(-len(plan.stations) // 64)
        floor.calls = self.ints([0] * floor.n_words)
        have_room(self)
        use_rule(floor, plan.rule)
        floor.idle = WHEN_IDLE.index(plan.idle)
        floor.held_when_blocked = plan.when_blocked == "held"
        floor.losing = any(source.when_full == "lose" for source in plan.sources)
        floor.has_orders = any(source.kind == SCHEDULE for source in plan.sources)
        floor.n_limits = FIRST_ROTATION + len(plan.rotations)
        floor.start_s = plan.start_s
        floor.stretch_line, floor.automatic_line = line_of(settle.stretch_done), line_of(settle.automatic_done)
        floor.operation_line, floor.report_line = line_of(flow.operation_done), line_of(settle.report)

    def _outside(self) -> Handle:
        made = self.arena.new("Station")
        made.rank = made.place = -1
        return made

    def _task(self, rank: int) -> Handle:
        task, made = self.plan.tasks[rank], self.arena.new("Task")
        made.rank, made.repeat, made.automatic, made.attended = rank, task.repeat, task.automatic, task.attended
        made.team, made.per_lot, made.mean_s = task.team, task.per_lot, task.mean_s()
        made.rule = -1 if task.interruption is None else INTERRUPTION_RULES[task.interruption]
        made.n_needs = len(task.needs)
        made.needs = self.ints(number for need in task.needs for number in need)
        made.hold_tool = -1 if task.hold is None else task.hold.tool
        made.of = rank if task.of is None else next(i for i, one in enumerate(self.plan.tasks) if one.name == task.of)
        return made

    def _station(self, rank: int) -> Handle:
        plan, made = self.plan.stations[rank], self.arena.new("Station")
        made.rank, made.place, made.servers, made.free_servers = rank, plan.place, plan.servers, plan.servers
        made.capacity, made.buffer, made.buffer_after = plan.capacity, plan.buffer, plan.buffer_after
        made.kind, made.priority = ("station", "store", "conveyor").index(plan.kind), plan.priority
        made.stands_for = IS_DOWN
        made.finishes_at_close = plan.at_close == "finish"
        made.has_hours = plan.open_s is not None
        made.setup_attended = 1
        self.set_tasks(made, plan.tasks)
        made.luck = self.ints([0] * len(self.plan.tasks))
        made.next_k = self.ints([0] * len(self.plan.tasks))
        made.line_at = -1
        return made

    def set_tasks(self, station: Handle, ranks: Any) -> None:
        """What a job gets at a station."""
        tasks = [self.plan.tasks[rank] for rank in ranks]
        station.n_tasks, station.tasks = len(tasks), self.ints(ranks)
        station.automatic = self.ints(task.automatic for task in tasks)
        station.repeats = self.ints(task.repeat for task in tasks)
        station.per_lot = self.ints(task.per_lot for task in tasks)

    def _add_gates(self) -> None:
        wanted = {operation.stations: None for product in self.plan.products for operation in product.route}
        for number, ranks in enumerate(wanted):
            made = self.gates[ranks] = self.arena.new("Gate")
            made.rank, made.n_stations = number, len(ranks)
            made.stations = self.arena.array("Station", [self.stations[rank] for rank in ranks])
            made.mask = self.ints(rank in ranks for rank in range(len(self.stations)))
            made.comes_back = _comes_back(self.plan, ranks)
        for rank, station in enumerate(self.stations):
            found = [gate for ranks, gate in self.gates.items() if rank in ranks]
            station.n_wanted_by, station.wanted_by = len(found), self.arena.array("Gate", found)

    def way(self, ways: Any) -> Handle:
        """Where jobs go on."""
        made = self.arena.new("Way")
        made.n, made.cumulative = len(ways), self.floats(point for point, _ in ways)
        made.to = self.ints(step for _, step in ways)
        return made

    def _product(self, rank: int) -> Handle:
        plan, made = self.plan.products[rank], self.arena.new("Product")
        made.rank, made.n_steps, made.start = rank, len(plan.route), self.way(plan.start)
        steps = [self._route_step(operation, plan.onward[i]) for i, operation in enumerate(plan.route)]
        made.steps = self.arena.array("RouteStep", steps)
        made.carried, made.priority, made.due_s, made.lot = plan.carried, plan.priority, plan.due_s, plan.lot
        made.mass_kg = nan if plan.mass_kg is None else plan.mass_kg
        ahead = self.plan.ahead
        if ahead is not None:
            made.at_s, made.work_s = self.floats(ahead.at_s[rank]), self.floats(ahead.work_s[rank])
            made.left_s, made.left_steps = self.floats(ahead.left_s[rank]), self.floats(ahead.left_steps[rank])
        return made

    def _route_step(self, operation: Any, onward: Any) -> Handle:
        made = self.arena.new("RouteStep")
        made.operation = self.plan.operations.index(operation.name)
        made.gate, made.way = self.gates[operation.stations], self.way(onward)
        listed = operation.listed or operation.stations
        places = {rank: position for position, rank in enumerate(listed)}
        made.position = self.ints(places.get(rank, 0) for rank in range(len(self.stations)))
        return made

    def _source(self, rank: int) -> Handle:
        plan, made = self.plan.sources[rank], self.arena.new("Source")
        made.rank, made.at_once, made.loses = rank, plan.at_once, plan.when_full == "lose"
        made.kind = BY_TIME if plan.kind in (POISSON, RENEWAL) else BY_ORDER if plan.kind == SCHEDULE else BY_FLOOR
        made.n_sequence, made.sequence = len(plan.sequence), self.ints(plan.sequence)
        made.n_mix, made.ranks = len(plan.mix), self.ints(product for product, _ in plan.mix)
        made.n_orders = len(plan.orders)
        made.orders = self.arena.array("Order", [self._order(order) for order in plan.orders])
        made.store, made.level = plan.store, plan.level
        self._set_hours(made, plan.open_s)
        return made

    def _order(self, order: Any) -> Handle:
        made = self.arena.new("Order")
        made.time_s, made.first, made.quantity, made.product = order.time_s, order.first, order.quantity, order.product
        made.due_s, made.priority = order.due_s, nan if order.priority is None else order.priority
        return made

    def _set_hours(self, source: Handle, open_s: OPEN | None) -> None:
        source.n_hours = -1
        if open_s is not None:
            source.n_hours, source.hours = len(open_s), self.floats(edge for pair in open_s for edge in pair)

    def _worker(self, rank: int) -> Handle:
        plan, made = self.plan.workers[rank], self.arena.new("Worker")
        speed, n_stations = plan.walk_m_per_s, len(self.stations)
        made.rank, made.place, made.home, made.walk_m_per_s = rank, plan.place, plan.place, speed
        made.most_load_kg = nan if plan.most_load_kg is None else plan.most_load_kg
        made.walk_s = self.floats(
            row[station.place] / speed for row in self.plan.distance_m for station in self.plan.stations
        )
        made.rating = self.floats(plan.rating)
        made.own_skills = self.ints(self.bits(i for i in range(n_stations) if plan.rating[i] > 0))
        made.skills = self.ints([0] * self.floor.n_words)
        made.limits = self.ints([0] * self.floor.n_words * self.floor.n_limits)
        made.limited = self.ints([0] * self.floor.n_limits)
        made.luck, made.next_k = self.ints([0] * len(self.plan.tasks)), self.ints([0] * len(self.plan.tasks))
        made.kind, made.cause, made.in_free, made.round = WAIT, IDLE, 1, -1
        made.walk_from = -1
        made.n_patrol, made.patrol = len(plan.patrol), self.ints(plan.patrol)
        made.quality = self.floats(plan.quality or (1.0,) * n_stations)
        made.has_zone, made.zone = bool(plan.zone), self.ints(i in plan.zone for i in range(n_stations))
        made.floater, made.absence = plan.floater, plan.absence
        return made

    def restrict(self, worker: Handle, limit: int, ranks: Any) -> None:
        """A limit leaves a worker the stations of some ranks, from the start."""
        n_words = self.floor.n_words
        worker.limited[limit] = 1
        for i, word in enumerate(self.bits(ranks)):
            worker.limits[limit * n_words + i] = word

    def _see_skills(self) -> None:
        """As ``bits.see_skills`` does in a run."""
        n_words, n_limits = self.floor.n_words, self.floor.n_limits
        for worker in self.workers:
            for i in range(n_words):
                left = worker.own_skills[i]
                for limit in range(n_limits):
                    if worker.limited[limit]:
                        left &= worker.limits[limit * n_words + i]
                worker.skills[i] = left


def _comes_back(plan: Plan, ranks: tuple[int, ...]) -> bool:
    """Whether a job that has a place at one of some stations may want in there without another one."""
    if plan.quality or any(station.place_first for station in plan.stations):
        return True
    return any(
        then >= 0 and product.route[then].stations == ranks and not set(ranks).isdisjoint(step.stations)
        for product in plan.products
        for step, ways in zip(product.route, product.onward)
        for _, then in ways
    )
