"""Floor: a whole floor of ours as a part of somebody's own SimPy model.

>>> import simpy
>>> from opsim import Floor, compile_plan, read_scenarios
>>> from opsim.shipped import shipped_folder
>>> def order(env, floor):
...     left = yield floor.release("carton")
...     print(f"a carton is {left.what} at {left.at_s:.0f} s, {left.stay_s:.0f} s after it came")
>>> env = simpy.Environment(initial_time=1000)
>>> floor = Floor(env, compile_plan(read_scenarios(shipped_folder() / "repack_cell.yaml")["base"]))
>>> _ = env.process(order(env, floor))
>>> env.run(until=4600)
a carton is finished at 1052 s, 52 s after it came
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from numbers import Integral
from typing import Any

import simpy

from opsim.clock import LONGEST_S
from opsim.engine.floor.run import FloorOfPlan
from opsim.engine.in_model import Inside, ask_for, happens_at, log_so_far, source_for, watch
from opsim.engine.shared_resources import SharedParts, SharedResources, SharedTool
from opsim.log import BAD, FINISH, JOIN, LOST, SCRAP, SPLIT, EventLog, names_of
from opsim.plan import Plan
from opsim.plan.plan import until
from opsim.problems import did_you_mean, shown
from opsim.subjects.release.plan import BASE_STOCK

WHAT = {FINISH: "finished", SCRAP: "scrapped", JOIN: "joined", SPLIT: "split", LOST: "lost"}
"""What may become of a job, by the kind of its last row; or ``INSIDE``."""
INSIDE = "inside"
"""What became of a job that had not left when the floor's run was over."""


class FloorEnded(RuntimeError):
    """A floor was asked for something after the end of its run."""


@dataclass(frozen=True, slots=True)
class Left:
    """A job that has left a floor. Times are those of the environment's clock, in seconds.

    what   : ``finished``, ``scrapped``, ``joined`` (to another job), ``split`` (into others), ``lost`` (its source does
             not wait for room), or ``inside`` where it was on the floor still as the run was over
    good   : whether it is finished and not bad
    number : of the job in the log; units : how many pieces it stands for
    """

    product: str
    what: str
    created_s: float
    at_s: float
    good: bool
    number: int
    units: int

    @property
    def stay_s(self) -> float:
        """Seconds that it was on the floor, or waited to come in."""
        return self.at_s - self.created_s


class Floor:
    """The floor of a Plan in a SimPy environment, from the environment's time on for the Plan's horizon.

    env  : your SimPy environment; it may be a RealtimeEnvironment, start at any time, and hold several floors
    plan : as ``compile_plan`` makes it
    replication : number of the replication: it decides all draws
    tools : by the scenario's name of a tool the Resource or Container of your model that it is taken from: asked for
        when a job waits for it, given back when no job wants it. A machine of yours that serves jobs of the floor is a
        tool that its station ``needs``
    parts : by the name of a product with a source of kind base stock the Container out of which that source keeps its
        store filled, a lot at a time

    leaving : a ``simpy.Store`` into which each finished job is put as a ``Left``, for you to get
    ended   : an event that fires as the run is over, its value the EventLog
    start_s : the environment's time at which the floor's own clock is at 0: the log's times count from there

    Jobs come from the sources of the scenario, and by ``release``. With nothing else in the environment the rows are
    those of ``run_plan``, byte for byte. An instant of the floor comes after everything else of its time in the
    environment. A dispatching rule or a model that raises does so out of ``env.run``; the log so far stays.

    Raises TypeError or ValueError for arguments that make no sense, and for a clock on which the run would end too late
    to be kept to 2^-20 s.
    """

    def __init__(
        self,
        env: simpy.Environment,
        plan: Plan,
        replication: int = 0,
        *,
        tools: Mapping[str, simpy.Resource | simpy.Container] | None = None,
        parts: Mapping[str, simpy.Container] | None = None,
    ):
        _check(env, plan, replication)
        shared_tools, shared_parts = _shared_tools(env, plan, tools or {}), _shared_parts(env, plan, parts or {})
        self.env, self.leaving, self.ended = env, simpy.Store(env), env.event()
        self._plan, self._replication = plan, int(replication)
        self._asked: dict[int, simpy.Event] = {}
        self._created_s: dict[int, float] = {}
        self._n_asked = [0] * len(plan.sources)
        self._products = {product.name: rank for rank, product in enumerate(plan.products)}
        self._whole: EventLog | None = None
        self._of_plan = FloorOfPlan(plan)
        self._inside = Inside(env, plan.horizon_s, self._ends, self._looks)
        self._of_plan.open(self._inside.own, self._replication, processes=False)
        floor = self._of_plan.floor
        watch(floor, self._comes, self._leaves)
        self._shared = SharedResources(floor, shared_tools, shared_parts, self._soon, self._brought)
        self._inside.look_ahead()

    @property
    def start_s(self) -> float:
        """The environment's time at which the floor began."""
        return self._inside.start_s

    @property
    def now_s(self) -> float:
        """The floor's own clock: seconds since it began, at most its Plan's horizon."""
        return self._inside.now_s

    def release(self, product: str) -> simpy.Event:
        """Put one more job of a product on the floor now; the event fires when it leaves, its value a ``Left``.

        The job is one more of the source that makes the product (of several the first that is no schedule), with its
        rule for a full floor; the draws of its sources' own jobs stay as they are. Where it has not left as the run is
        over, the event fires then, ``what`` being "inside".
        Raises ValueError for an unknown product and one that no source makes, FloorEnded after the end of the run.
        """
        rank = self._rank(product)
        self._must_go_on(f"release {product}")
        source = source_for(self._plan, rank)
        if source < 0:
            raise ValueError(f"floor {self._plan.name}: cannot release {product}: no source of the scenario makes it")
        event = self.env.event()

        def created(job: Any) -> None:
            self._asked[job.number] = event

        self._ask_for(rank, source, created)
        return event

    def log(self) -> EventLog:
        """The log so far, by the floor's own clock; what is open now ends now, with its progress. The floor goes on.

        ``audit(floor.log(), floor.plan_so_far())`` and ``figures`` take it; after the end it is the whole log.
        """
        if self._whole is not None:
            return self._whole
        names = names_of(self._plan)
        return log_so_far(self._of_plan.floor, self._replication, self._inside.now_s, names)

    def plan_so_far(self) -> Plan:
        """The Plan with its horizon where the floor is now: what ``audit`` and ``figures`` ask for beside the log.

        Until its warm-up is over it has none.
        """
        return until(self._plan, self._plan.horizon_s if self._whole is not None else self._inside.now_s)

    def _ask_for(self, rank: int, source: int, created: Callable[[Any], None]) -> None:
        number = self._n_asked[source]
        self._n_asked[source] += 1
        ask_for(self._of_plan.floor, rank, source, number, created, self._inside.now_s)
        self._inside.look_ahead()

    def _brought(self, rank: int, source: int) -> None:
        """A lot has come out of a container of parts."""
        self._ask_for(rank, source, lambda job: None)

    def _soon(self, happens: Callable[[], None]) -> None:
        """Something happens on the floor in this instant."""
        happens_at(self._of_plan.floor, self._inside.now_s, lambda _floor, _event: happens())
        self._inside.look_ahead()

    def _looks(self) -> None:
        self._shared.look()

    def _rank(self, product: Any) -> int:
        if not isinstance(product, str) or product not in self._products:
            hint = did_you_mean(product, self._products, otherwise="its products")
            raise ValueError(f"floor {self._plan.name}: release: no product {shown(product)}; {hint}")
        return self._products[product]

    def _must_go_on(self, wanted: str) -> None:
        where = f"floor {self._plan.name}: cannot {wanted} at {self.env.now:g} s"
        if self._inside.failed:
            raise FloorEnded(f"{where}: an error ended its run at {self._inside.outer_s(self.now_s):g} s")
        if self.now_s >= self._plan.horizon_s:
            end_s = self._inside.outer_s(self._plan.horizon_s)
            raise FloorEnded(
                f"{where}: its run was over at {end_s:g} s; a longer horizon in the scenario keeps it going"
            )

    def _comes(self, job: Any) -> None:
        self._created_s[job.number] = self._inside.outer_s(self._of_plan.floor.now)

    def _leaves(self, job: Any, kind: int, cause: int) -> None:
        left = self._left(job, WHAT[kind], kind == FINISH and cause != BAD)
        if kind == FINISH:
            self.leaving.put(left)
        asked = self._asked.pop(job.number, None)
        if asked is not None:
            asked.succeed(left)

    def _left(self, job: Any, what: str, good: bool) -> Left:
        at_s = self._inside.outer_s(self._of_plan.floor.now)
        product = self._plan.products[job.product].name
        created_s = self._created_s.pop(
            job.number, self.start_s
        )  # jobs of the first stock were there before all others
        return Left(product, what, created_s, at_s, good, job.number, job.lot)

    def _ends(self) -> None:
        """The run is over: the rows that are open end, and nobody waits any longer for a job that is inside."""
        self._whole = self._of_plan.close(self._replication)
        self._shared.end()
        job = self._of_plan.floor.first_job
        while job is not None:
            if job.number in self._asked:
                self._asked.pop(job.number).succeed(self._left(job, INSIDE, False))
            job = job.next_on_floor
        self.ended.succeed(self._whole)


def _check(env: Any, plan: Any, replication: Any) -> None:
    """Raises TypeError or ValueError for what is no environment, Plan or number, and for a clock that is too late."""
    if not isinstance(env, simpy.Environment):
        raise TypeError(f"floor: expected a simpy.Environment first, found {shown(env)}")
    if not isinstance(plan, Plan):
        makes = "compile_plan(read_scenarios('my.yaml')['base']) makes one"
        raise TypeError(f"floor: expected a Plan second, found {shown(plan)}; {makes}")
    if isinstance(replication, bool) or not isinstance(replication, Integral) or replication < 0:
        raise ValueError(f"floor {plan.name}: replication must be a whole number from 0, found {shown(replication)}")
    if not abs(env.now) + plan.horizon_s <= LONGEST_S:
        raise ValueError(
            f"floor {plan.name}: the environment's clock is at {env.now:g} s, too late for a run of {plan.horizon_s:g} "
            f"s: times are kept to 2^-20 s as far as {LONGEST_S:g} s; begin the environment earlier"
        )


def _shared_tools(env: simpy.Environment, plan: Plan, tools: Mapping[str, Any]) -> list[SharedTool]:
    """Raises TypeError or ValueError for what cannot be shared."""
    known: dict[str, int] = {tool.name: rank for rank, tool in enumerate(plan.tools)}
    found = []
    for name, source in tools.items():
        place = f"floor {plan.name}: tools: {name}"
        if name not in known:
            hint = did_you_mean(name, known, otherwise="its tools") or "it has none"
            raise ValueError(f"{place}: the scenario has no such tool; {hint}")
        if not isinstance(source, simpy.Resource | simpy.Container) or isinstance(source, simpy.PreemptiveResource):
            raise TypeError(
                f"{place}: expected a simpy.Resource that is not preemptive, or a Container, found {shown(source)}"
            )
        n = plan.tools[known[name]].n
        _check_shared(env, source, place)
        if source.capacity < n:
            raise ValueError(f"{place}: the scenario has {n} of it, your resource has room for {source.capacity:g}")
        found.append(SharedTool(source, known[name], n))
    return found


def _shared_parts(env: simpy.Environment, plan: Plan, parts: Mapping[str, Any]) -> list[SharedParts]:
    """Raises TypeError or ValueError for what cannot be shared."""
    made = [(source.mix[0][0], rank) for rank, source in enumerate(plan.sources) if source.kind == BASE_STOCK]
    sources, found = {plan.products[product].name: (product, rank) for product, rank in made}, []
    for name, container in parts.items():
        place = f"floor {plan.name}: parts: {name}"
        if name not in sources:
            hint = did_you_mean(name, sources, otherwise="products that have one") or "the scenario has none"
            raise ValueError(f"{place}: no source of kind base_stock keeps a store filled with it; {hint}")
        if not isinstance(container, simpy.Container):
            raise TypeError(f"{place}: expected a simpy.Container, found {shown(container)}")
        _check_shared(env, container, place)
        lot = plan.products[sources[name][0]].lot
        if container.capacity < lot:
            raise ValueError(f"{place}: a lot is {lot} pieces, your container holds {container.capacity:g} at most")
        found.append(SharedParts(container, *sources[name]))
    return found


def _check_shared(env: simpy.Environment, source: Any, place: str) -> None:
    if source._env is not env:
        raise ValueError(f"{place}: it belongs to another environment than the floor")
