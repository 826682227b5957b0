"""opsim, from scenario text to figures, event log on: as machines (automatic tasks) and manned (a worker each).

opsim draws from its own named streams; ``numbers`` are those a run will use, so that its answers can be exact too.
"""

from itertools import islice

from bench.peers.times import ARRIVALS_PER_S, BUFFER, N_STATIONS, POOL_ARRIVALS_PER_S, POOL_STATIONS, SKILLS, Given
from plans import line as line_text
from plans import plan
from plans import queue as queue_text

from opsim.clock import on_grid
from opsim.engine.draws import Draws
from opsim.engine.floor.run import run_plan
from opsim.log import CREATE, FINISH
from opsim.plan import Plan


def mm1(until_s, seed):
    return _times(run_plan(_mm1(until_s, seed)))


def mm1_manned(until_s, seed):
    return _times(run_plan(_mm1_manned(until_s, seed)))


def line(until_s, seed):
    return _rate(run_plan(_line(until_s, seed)))


def line_manned(until_s, seed):
    return _rate(run_plan(_line_manned(until_s, seed)))


def pool(until_s, seed):
    return _times(run_plan(_pool(until_s, seed)))


def numbers(variant: str, until_s: float, seed: int, n: int) -> Given:
    """The first n numbers of each kind that ``variant(until_s, seed)`` uses, on the engine's grid of time."""
    return numbers_of(PLANS[variant](until_s, seed), 0, n)


def numbers_of(plan: Plan, replication: int, n: int) -> Given:
    """The first n numbers of each kind that a replication of one of ``PLANS`` uses."""
    draws = Draws(plan, replication)
    saturated = plan.release.kind == "saturated"
    gaps = [] if saturated else [on_grid(gap_s) for gap_s in islice(draws.gaps(0), n)]
    if len(plan.workers) > 1 and len(plan.tasks) == 1:
        streams = [draws.durations(0, worker) for worker in range(len(plan.workers))]
    elif plan.workers:
        streams = [draws.durations(rank, rank) for rank in range(len(plan.stations))]
    else:
        streams = [draws.automatic_runs(rank, rank) for rank in range(len(plan.stations))]
    services = [[on_grid(s) for s in islice(stream, n)] for stream in streams]
    return Given(gaps, [*map(draws.products(0), range(len(gaps)))], services)


def _mm1_manned(until_s, seed):
    return plan(queue_text(horizon=f"{until_s} s", warm_up="0 s", every=f"{1 / ARRIVALS_PER_S} s", seed=seed))


def _mm1(until_s, seed):
    text = queue_text(horizon=f"{until_s} s", warm_up="0 s", every=f"{1 / ARRIVALS_PER_S} s", seed=seed)
    return plan(_automatic(text, after="allocation:"))


def _line_manned(until_s, seed):
    return plan(line_text(N_STATIONS, BUFFER, horizon=f"{until_s} s", warm_up="0 s", seed=seed))


def _line(until_s, seed):
    return plan(_automatic(line_text(N_STATIONS, BUFFER, horizon=f"{until_s} s", warm_up="0 s", seed=seed)))


def _automatic(text: str, after: str = "") -> str:
    """Without the workers, each task by itself."""
    before, rest = text.replace("mean: 1 s}", "mean: 1 s, automatic: true}").split("workers:")
    return before + (after + rest.split(after)[1] if after else "")


def _pool(until_s, seed):
    stations = range(POOL_STATIONS)
    skills = ["{" + ", ".join(f"s{s}: 1.0" for s in sorted(able)) + "}" for able in SKILLS]
    return plan("\n".join([
        "opsim: 1",
        "name: pool",
        f"run: {{horizon: {until_s} s, seed: {seed}}}",
        "layout: {places: {floor: [0 m, 0 m]}}",
        "tasks: {t: {dist: exponential, mean: 1 s}}",
        "stations: {" + ", ".join(f"s{s}: {{at: floor, tasks: [t], servers: {len(SKILLS)}}}" for s in stations) + "}",
        "products: {" + ", ".join(f"p{s}: {{share: {1 / POOL_STATIONS}, route: [s{s}]}}" for s in stations) + "}",
        f"release: {{kind: poisson, every: {1 / POOL_ARRIVALS_PER_S} s}}",
        "workers: {" + ", ".join(f"w{w}: {{skills: {able}}}" for w, able in enumerate(skills)) + "}",
        "allocation: {rule: oldest_job}",
    ]))  # fmt: skip


PLANS = {"mm1": _mm1, "mm1_manned": _mm1_manned, "line": _line, "line_manned": _line_manned, "pool": _pool}


def _times(log) -> tuple[int, float]:
    """Jobs finished, and their mean time from coming in to leaving."""
    created, finished = log.of(CREATE), log.of(FINISH)
    came_s = dict(zip(created["job"].tolist(), created["end_s"].tolist()))
    spent = [left_s - came_s[job] for job, left_s in zip(finished["job"].tolist(), finished["end_s"].tolist())]
    return len(spent), sum(spent) / len(spent)


def _rate(log) -> tuple[int, float]:
    finished = len(log.of(FINISH))
    return finished, finished / log.horizon_s
