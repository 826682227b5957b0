"""What becomes of people as they work: parameters of effects, and what each worker has behind him."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.parts.records import Event, Hook
from opsim.engine.floor.parts.state import Worker


@struct
class Model:
    """Parameters of a model of ``opsim.human`` by their names there: its methods are compiled with this for ``self``.

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
    spare: int
    worked: List[Worker]
    n_resting: int


@struct
class Human:
    """Of a worker. tired .. done : see ``opsim.human.tired``; ``tired`` is his fatigue, or that of his worst joint

    shares : address of (J, 5) numbers of his muscles; heaviness, courses : by task, how heavy it is for him, NaN where
            nobody has asked; address of the (PARTS, J) course of loads, 0 where none is known, -1 before
    units .. busy_until_s : see ``opsim.human.memory``; last_s : NaN where he has never done it
    has_worked, resting : see ``human_rest``
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
