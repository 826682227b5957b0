"""Who does what: two neighbours who share work, a helper with two skills, a round with one job a stop.

The first two come from Markov chains listed here; ``known_answers.json`` has neither. The round comes from the
pseudo-conservation law of Boxma & Groenendijk (1987), Pseudo-conservation laws in cyclic-service systems, J. Applied
Probability 24:949-964: exact where all stations are alike.
"""

from known_answers.case import Case
from known_answers.markov import shares_of_time

BASE_S, SHARED_S, CLOSE_S = 0.8, 0.4, 0.8
BLOCKED, IDLE, BASE, SHARED, CLOSE = "blocked", "idle", "base", "shared", "close"


def sharing_rate(room: int, filled: float) -> float:
    """Jobs a second of a saturated line of two: base, then the shared task at either of them, then closing.

    All times are exponential; the first does the shared task itself where the second is busy and at least ``filled`` of
    the ``room`` places between them are taken. States: (what the first does, for each job that waits whether the
    shared task is left to do, what the second does); a blocked first has done the shared task, or not.
    """

    def moves(state):
        first, waiting, second = state
        if first == BASE:
            keeps = second != IDLE and len(waiting) >= filled * room
            yield 1 / BASE_S, (SHARED, waiting, second) if keeps else arrived(True, waiting, second)
        elif first == SHARED:
            yield 1 / SHARED_S, arrived(False, waiting, second)
        if second == SHARED:
            yield 1 / SHARED_S, (first, waiting, CLOSE)
        elif second == CLOSE:
            yield 1 / CLOSE_S, left(first, waiting)

    def arrived(to_do, waiting, second):
        if second == IDLE:
            return BASE, waiting, SHARED if to_do else CLOSE
        if len(waiting) < room:
            return BASE, (*waiting, to_do), second
        return (BLOCKED, to_do), waiting, second

    def left(first, waiting):
        if isinstance(first, tuple):
            first, waiting = BASE, (*waiting, first[1])
        if not waiting:
            return first, (), IDLE
        return first, waiting[1:], SHARED if waiting[0] else CLOSE

    shares = shares_of_time((BASE, (), IDLE), moves)
    return sum(share for (_, _, second), share in shares.items() if second == CLOSE) / CLOSE_S


ROOM_A, ROOM_B = 8, 5
RATE_A, RATE_B = 1.1, 0.5
SPEED_AT_A = {"one": 1.0, "two": 0.8}
"""The N-model: one can do a alone, two can do b, his own, and helps at a. Jobs that find no room are lost."""


def helped() -> dict[str, float]:
    """Jobs done a second, and jobs inside, of the N-model: states (jobs at a, at b, whether one works, what two does).

    Who is free takes the oldest job at a; two does b first, helps at a only where one is busy, and is not interrupted.
    """

    def moves(state):
        at_a, at_b, one, two = state
        if at_a < ROOM_A:
            yield RATE_A, sent(at_a + 1, at_b, one, two)
        if at_b < ROOM_B:
            yield RATE_B, sent(at_a, at_b + 1, one, two)
        if one:
            yield SPEED_AT_A["one"], sent(at_a - 1, at_b, False, two)
        if two == "a":
            yield SPEED_AT_A["two"], sent(at_a - 1, at_b, one, "")
        if two == "b":
            yield 1.0, sent(at_a, at_b - 1, one, "")

    def sent(at_a, at_b, one, two):
        waiting = at_a - one - (two == "a")
        if waiting and not one:
            one, waiting = True, waiting - 1
        if not two:
            two = "b" if at_b else "a" if waiting else ""
        return at_a, at_b, one, two

    shares = shares_of_time((0, 0, False, ""), moves)
    inside = sum(share * (at_a + at_b) for (at_a, at_b, _, _), share in shares.items())
    rate = {"": 0.0, "a": SPEED_AT_A["two"], "b": 1.0}
    done = sum(share * (SPEED_AT_A["one"] * one + rate[two]) for (_, _, one, two), share in shares.items())
    return {"throughput": done, "inside": inside}


def limited_wait_s(n: int, arrivals_per_s: float, walk_s: float) -> float:
    """Mean wait of a job at each of n alike stations, one exponential job of 1 s a visit, all walks alike."""
    load, round_s = n * arrivals_per_s, n * walk_s
    right = load * n * arrivals_per_s * 2 / (2 * (1 - load)) + load * round_s / 2
    right += round_s / (2 * (1 - load)) * (load**2 + n * arrivals_per_s**2)
    return right / (load * (1 - arrivals_per_s * round_s / (1 - load)))


_SHARED = {"half_full": (4, 0.5), "full": (4, 1.0), "one_place": (1, 0.5), "no_place": (0, 0.5)}
CASES = (
    *(
        Case("work_sharing", variant, "throughput_per_h", sharing_rate(*rule), scale=3600.0, few=6)
        for variant, rule in _SHARED.items()
    ),
    Case("n_model", "base", "throughput_per_h", helped()["throughput"], scale=3600.0),
    Case("n_model", "base", "work_in_progress", helped()["inside"], most_half_width=0.02),
    Case(
        *("polling", "limited", "time_in_system_s", limited_wait_s(4, 0.2, 0.1)),
        shift=1.0,
        most_half_width=0.02,
        few=40,
    ),
)
