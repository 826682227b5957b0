"""Job rotation: people change posts by the clock, by what was done, or by a rule."""

from collections.abc import Callable
from functools import partial

from opsim.engine.rules import CALENDAR
from opsim.engine.rules.allocation import less_gone_through
from opsim.engine.simpy_engine.doses import heaviest_first
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.log import ABSENT, OFF
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plan.rotations import RotationPlan
from opsim.plugins import rule_of
from opsim.posts import given_out

BY_CLOCK = "posts change by the clock"
COUNT = 1
"""Among what is asked when an operation is done: it is counted before anything becomes of the job."""


class Rotation:
    """Who of a rotation is at which post. Members and posts are numbers in their lists.

    order : posts by how heavy they are, once a rule has asked
    turn : changes so far; at : {member: post} of those who are there; since_s : since when these are the posts
    time_s, here_s : (members, posts) seconds so far, and since he came there
    """

    def __init__(self, floor: Floor, plan: RotationPlan, rank: int):
        self.plan, self.rank, self.name = plan, rank, f"rotation {plan.name}"
        self.members = [floor.workers[worker] for worker in plan.workers]
        self.rule = rule_of("opsim.rotation", plan.rule)
        self.can = plan.can(floor.plan.workers)
        everywhere = (1 << len(floor.stations)) - 1
        self.leaves = [plan.leaves(post, everywhere) for post in range(len(plan.posts))]
        self.turn, self.due = 0, False
        self.there: list[int] = []
        self.order: list[int] = []
        self.at: dict[int, int] = {}
        self.since_s = 0.0
        self.n_done = [0] * len(plan.posts)
        self.time_s = [[0.0] * len(plan.posts) for _ in plan.workers]
        self.here_s = [[0.0] * len(plan.posts) for _ in plan.workers]

    def keep_up(self, floor: Floor) -> bool:
        """Posts are given out anew where a change is due, or somebody has come or gone."""
        there = [n for n, worker in enumerate(self.members) if _is_there(worker)]
        if self.due or there != self.there:
            if self.due:
                self.turn += 1
                self.due, self.n_done = False, [0] * len(self.n_done)
            self.there = there
            self._give_out(floor)
        return False

    def _give_out(self, floor: Floor) -> None:
        self._count_time(floor)
        at = self._posts(floor)
        for member, worker in enumerate(self.members):
            post = at.get(member)
            if post != self.at.get(member):
                self.here_s[member] = [0.0] * len(self.plan.posts)
                worker.restrict(self.name, None if post is None else self.leaves[post])
        self.at = at

    def _posts(self, floor: Floor) -> dict[int, int]:
        """{member: post} from now on, by the rule."""
        if not self.there:
            return {}
        n_posts, away = len(self.plan.posts), self.plan.turns_away(self.there, self.turn)

        def key(member: int, slot: int) -> tuple[float, ...]:
            post = slot % n_posts
            return self.rule(away(member, slot), self.time_s[member][post], self.here_s[member][post], member)

        if self.plan.rule == LEAST_EXPOSED:
            return self._by_dose(floor, key)
        return given_out(n_posts, self.there, self.can, key)

    def _by_dose(self, floor: Floor, key: Callable[[int, int], tuple[float, ...]]) -> dict[int, int]:
        """{member: post}: the heaviest post first, each to whose body has gone through least so far."""
        order = self.order = self.order or heaviest_first(floor, self.plan.posts, self.plan.workers)
        n_posts, dose = len(order), {n: floor.doses[self.members[n].rank].so_far(floor.now) for n in self.there}

        def slot_of(number: int) -> int:
            return order[number % n_posts] + number - number % n_posts

        at = given_out(
            n_posts,
            self.there,
            lambda member, number: self.can(member, order[number]),
            lambda member, number: (*less_gone_through(dose[member]), *key(member, slot_of(number))),
        )
        return {member: order[number] for member, number in at.items()}

    def _count_time(self, floor: Floor) -> None:
        for member, post in self.at.items():
            self.time_s[member][post] += floor.now - self.since_s
            self.here_s[member][post] += floor.now - self.since_s
        self.since_s = floor.now

    def change(self, floor: Floor) -> None:
        """By the clock: a change is due, and the next one to come."""
        self.due = True
        self.set_clock(floor)

    def set_clock(self, floor: Floor) -> None:
        """The next change by the clock."""
        if self.plan.every_s is not None:
            floor.alarm(self.plan.every_s, CALENDAR, self.rank, 0, BY_CLOCK, self)

    def done(self, posts: tuple[int, ...], _floor: Floor, _job: Job) -> bool:
        """An operation is done at some of the posts; a change is due where there were enough."""
        for post in posts:
            self.n_done[post] += 1
            self.due = self.due or self.n_done[post] >= self.plan.after  # type: ignore[operator]
        return True


def _is_there(worker: Worker) -> bool:
    """On shift, or in overtime; not who merely finishes something before he goes."""
    return worker.kind != OFF and worker.kind != ABSENT and not worker.going


def install(floor: Floor) -> None:
    """Each rotation looks who is there before anybody is sent."""
    for rank, plan in enumerate(floor.plan.rotations):
        rotation = Rotation(floor, plan, rank)
        floor.dispatchers.insert(rank, rotation.keep_up)
        rotation.set_clock(floor)
        for station in floor.stations if plan.after is not None else ():
            _count_at(station, rotation)


def _count_at(station: Station, rotation: Rotation) -> None:
    """Operations at a station count for the posts that it is part of."""
    posts = tuple(number for number, post in enumerate(rotation.plan.posts) if station.rank in post)
    if posts:
        station.add_after(COUNT, partial(rotation.done, posts))


HANDLERS: dict[str, Handler] = {BY_CLOCK: lambda floor, rotation: rotation.change(floor)}
