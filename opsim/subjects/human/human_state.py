"""What becomes of people as they work: parameters of effects, what each worker has behind him, and what he gathers.

Fatigue, memory of tasks and dose are told when he works and when he is broken off. See ``subjects.human``.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.machine import Array, Call, List, address_of, call_out, inlined, struct
from opsim.engine.floor.records import Hook
from opsim.engine.floor.state import Event, Worker
from opsim.plan import Plan
from opsim.subjects.tasks.plan import performed_ranks


@struct
class Model:
    """Parameters of a model of human effects by their names there: its methods are compiled with this for ``self``.

    kind : which curve of learning it is
    """

    kind: int
    rate: float
    measured_at: float
    floor: float
    incompressible: float
    prior: float
    half_at: float
    cognitive_rate: float
    motor_rate: float
    cognitive_share: float
    forgotten_in_s: float
    least_pause_s: float
    tires_half_in_s: float
    recovers_half_in_s: float
    slows: float
    above: float
    until: float
    faster: float
    slower: float
    full_at: float
    amplitude: float
    peak_s: float
    at_full_fatigue: float


@struct
class Effects:
    """Of a floor. shifts, factors : steps ``(floor, worker, station)`` that put what they say into ``answer``

    forgets, rests : whether people do; pass_line, rest_line : steps told of somebody that time goes on for him until
            now, and asked how long he has to rest
    first_s : by task, mean time of its first repetition; fed : by station, whether others come before it
    ask_burden : address of what Python is asked of (worker, task); spare : (J, 5) where muscles rest on trial
    worked : who has worked since he was looked at, by rank; n_resting : who rest by need
    """

    shifts: List[Hook]
    factors: List[Hook]
    answer: float
    on_posture: int
    learning: Model
    forgetting: Model
    fatigue: Model
    rest: Model
    state_pace: Model
    circadian: Model
    errors: Model
    forgets: int
    rests: int
    pass_line: Call
    rest_line: Call
    first_s: Array[float]
    fed: Array[int]
    ask_burden: int
    call_passed: int
    call_rest_to_s: int
    spare: int
    worked: List[Worker]
    n_resting: int


@struct
class Human:
    """Of a worker. tired .. done : see ``fatigue``; ``tired`` is his fatigue, or that of his worst joint

    shares : address of (J, 5) numbers of his muscles; heaviness, courses : by task, how heavy it is for him, NaN where
            nobody has asked; address of the (PARTS, J) course of loads, 0 where none is known, -1 before
    units .. busy_until_s : see ``opsim.subjects.human.forgetting``; last_s : NaN where he has never done it
    has_worked, resting : see ``human_effects``
    """

    worker: Worker
    effects: Effects
    tired: float
    at_s: float
    task: int
    begun_s: float
    until_s: float
    done: float
    shares: int
    heaviness: Array[float]
    courses: Array[int]
    experience: Array[float]
    units: Array[float]
    last_s: Array[float]
    asked: int
    asked_task: int
    asked_k: int
    asked_units: float
    busy: int
    busy_task: int
    busy_from_s: float
    busy_until_s: float
    has_worked: int
    resting: Event


@inlined
def pass_to_now(floor: Floor, human: Human) -> None:
    """Time goes on for his fatigue until now."""
    if human.at_s < floor.now:
        human.effects.pass_line(floor, human)


@inlined
def level(floor: Floor, human: Human) -> float:
    """How tired he is, 0 (fresh, or where nobody tires) to 1."""
    if not human.effects.pass_line:
        return 0.0
    pass_to_now(floor, human)
    return human.tired


@inlined
def tires(floor: Floor, human: Human, task: int, until_s: float, done: float) -> None:
    """He works on a task from now, at a share of it, until it is done then."""
    pass_to_now(floor, human)
    human.task, human.begun_s, human.until_s, human.done = task, floor.now, until_s, done


@inlined
def stops_tiring(floor: Floor, human: Human) -> None:
    """He works no more."""
    pass_to_now(floor, human)
    human.task = -1


@inlined
def note_that_he_works(floor: Floor, human: Human) -> None:
    """Nobody else can have become too tired. Those who have worked are in the order of their ranks."""
    if human.has_worked:
        return
    human.has_worked = 1
    worked, rank = human.effects.worked, human.worker.rank
    at = len(worked)
    while at > 0 and worked[at - 1].rank > rank:
        at -= 1
    worked.insert(at, human.worker)


@inlined
def memory_works(floor: Floor, human: Human, task: int, k: int, until_s: float) -> None:
    """He works on his k-th of a task from now until then, if nothing comes between."""
    memory_passes(floor, human)
    if human.asked and (human.asked_task != task or human.asked_k != k):
        human.asked = 0  # it came to nothing
    human.busy, human.busy_task, human.busy_from_s, human.busy_until_s = 1, task, floor.now, until_s


@inlined
def memory_stops(floor: Floor, human: Human) -> None:
    """What he worked on is broken off."""
    memory_passes(floor, human)
    human.busy = 0


@inlined
def memory_passes(floor: Floor, human: Human) -> None:
    """What he has worked on until now counts; of one performance, once."""
    if not human.busy or floor.now <= human.busy_from_s:
        return
    human.last_s[human.busy_task] = min(floor.now, human.busy_until_s)
    if human.asked:
        human.units[human.busy_task], human.asked = human.asked_units, 0


@struct
class Dose:
    """Of one worker. rates : by task, NaN where nobody has asked; ask_rate, ask_order : addresses of what to ask

    before : of all that is over; per_s, since_s, until_s : of what he is at, or was at last
    """

    before: float
    per_s: float
    since_s: float
    until_s: float
    rates: Array[float]
    ask_rate: int
    ask_order: int


@inlined
def dose_so_far(floor: Floor, worker: Worker) -> float:
    """Until now."""
    dose = worker.dose
    return dose.before + dose.per_s * (min(floor.now, dose.until_s) - dose.since_s)


@inlined
def rate_of(floor: Floor, worker: Worker, task: int) -> float:
    """RULA x seconds of a second of his work."""
    dose = worker.dose
    if dose.rates[task] != dose.rates[task]:  # NaN
        call_out(dose.ask_rate, worker.rank, task)
    return dose.rates[task]


@inlined
def heaviest_first(floor: Floor, worker: Worker, rotation: int, order: Array[int]) -> None:
    """Numbers of the posts of a rotation by how much they add to a body; ``worker`` : any who has a dose.

    NOTE: Python sums it, which is not the same in all its versions.
    """
    call_out(worker.dose.ask_order, rotation, address_of(order))


def posts_by_strain(plan: Plan, rates: Any, posts: Sequence[Sequence[int]], members: Sequence[int]) -> list[int]:
    """What is answered: those first where a job adds most to a body, on the mean of the members; else as they stand."""

    def added(post: Sequence[int]) -> float:
        tasks = [task for station in post for task in plan.stations[station].tasks]
        return sum(plan.tasks[task].mean_s() * per_s(task) for task in tasks)

    def per_s(task: int) -> float:
        levels = performed_ranks(plan.tasks, task)
        return sum(rates.per_s(member, level) for member in members for level in levels) / len(members) / len(levels)

    strain = [added(post) for post in posts]
    return sorted(range(len(posts)), key=lambda post: (-strain[post], post))
