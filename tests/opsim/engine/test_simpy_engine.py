"""The engine against recursions that are exact for the same draws, and against laws that hold in any scenario.

The estimate of work is made of visits, which a run counts.

Dispatching where it comes to no rest.

Who wants in where there is no room: only who would come back is looked for among the others.
"""

from types import SimpleNamespace

import numpy as np
import plans
import pytest
from plans import CELL, line, plan, queue

from opsim.clock import on_grid
from opsim.engine.choice import simpy_s, visits
from opsim.engine.draws import Draws
from opsim.engine.endless import EndlessInstant, endless_instant
from opsim.engine.floor import build, settle
from opsim.engine.floor.run import run_plan
from opsim.engine.floor.settle import ENDLESS, dispatch
from opsim.kpi import figures
from opsim.log import BLOCKED, COLUMNS, CREATE, FINISH, HELD, JOB_BLOCKED, LOST, WAIT, WALK, WORK
from opsim.subjects.routes import routing


def naive_line(times, buffers):
    """Departures (jobs, stations) of a saturated line, blocking after service; job i needs times[i, j] at station j.

    Source: the max-plus recursion, e.g. Dallery & Gershwin 1992, sec. 5.
    """
    n, m = times.shape
    leave = np.zeros((n, m))
    for i in range(n):
        for j in range(m):
            start = max(leave[i - 1, j] if i else 0.0, leave[i, j - 1] if j else 0.0)
            leave[i, j] = start + times[i, j]
            ahead = i - buffers[j + 1] - 1 if j + 1 < m else -1
            if ahead >= 0:
                leave[i, j] = max(leave[i, j], leave[ahead, j + 1])
    return leave


@pytest.mark.parametrize(("n_stations", "buffer"), [(1, 0), (2, 0), (2, 3), (4, 1), (5, 0)])
def test_a_line_is_the_recursion_to_the_last_bit(n_stations, buffer):
    p = plan(line(n_stations, buffer, horizon="400 s", warm_up="0 s", seed=9))
    finished = run_plan(p).of(FINISH)
    draws = Draws(p, 0)
    times = [[on_grid(draws.duration_s(j, j, i)) for j in range(n_stations)] for i in range(len(finished))]
    leave = naive_line(np.array(times), [0] + [buffer] * (n_stations - 1))
    assert np.array_equal(np.sort(finished["end_s"]), leave[:, -1])


def test_one_server_is_lindleys_recursion_to_the_last_bit():
    p = plan(queue(horizon="2000 s", warm_up="0 s", seed=4))
    finished = run_plan(p).of(FINISH)
    draws, arrive, leave = Draws(p, 0), 0.0, 0.0
    expected = []
    for i, gap_s in zip(range(len(finished)), draws.gaps(0)):
        arrive += on_grid(gap_s)
        leave = max(arrive, leave) + on_grid(draws.duration_s(0, 0, i))
        expected.append(leave)
    assert np.array_equal(finished["end_s"], expected)


def rows(log, keep=None):
    text = {c: np.array([*log.names[c], ""], dtype=object)[log[c]] for c in log.names}
    columns = [text.get(c, log[c]) for c in COLUMNS if c != "performance_id"]
    everything = list(zip(*(map(str, column) for column in columns)))
    return everything if keep is None else [row for row in everything if keep not in row]


def test_the_same_seed_gives_the_same_rows_and_another_does_not():
    p = plan(CELL)
    assert rows(run_plan(p, 1)) == rows(run_plan(p, 1)) != rows(run_plan(p, 2))


@pytest.mark.parametrize("text", [CELL, queue(horizon="3000 s", servers=2)])
def test_an_idle_worker_more_changes_no_other_row(text):
    place, task = ("rack", "stow") if text is CELL else ("counter", "serve")
    more = text.replace("\nworkers:\n", "\nworkers:\n  aaron: {skills: {spare: 1.0}}\n").replace(
        "\nworkers: {", "\nworkers: {aaron: {skills: {spare: 1.0}}, "
    )
    spare = f"spare: {{at: {place}, tasks: [{task}]}}"
    more = more.replace("\nstations:\n", f"\nstations:\n  {spare}\n").replace(
        "\nstations: {", f"\nstations: {{{spare}, "
    )
    before, after = run_plan(plan(text)), run_plan(plan(more))
    assert len(after) == len(before) + 1
    assert rows(before) == rows(after, keep="aaron")


def test_declaration_order_decides_nothing():
    reordered = CELL
    for block in ("workers", "stations", "tasks", "products"):
        head, tail = reordered.split(f"\n{block}:\n")
        lines = tail.split("\n")
        n = next(i for i, line in enumerate(lines) if not line.startswith("  "))
        reordered = f"{head}\n{block}:\n" + "\n".join([*lines[:n][::-1], *lines[n:]])
    assert reordered != CELL
    assert rows(run_plan(plan(reordered))) == rows(run_plan(plan(CELL)))


def test_littles_law_holds_exactly_over_the_whole_run():
    p = plan(CELL.replace("warm_up: 10 min", "warm_up: 0 s"))
    log = run_plan(p)
    stay = np.full(len(log.of(CREATE)), log.horizon_s)
    gone = log.of(FINISH, LOST)
    stay[gone["job"]] = gone["end_s"]
    created = log.of(CREATE)
    stay[created["job"]] -= created["end_s"]
    inside = next(f.value for f in figures(log, p) if f.kpi == "work_in_progress")
    assert inside * log.horizon_s == pytest.approx(stay.sum(), rel=1e-12)


def test_a_skill_of_two_halves_every_duration():
    slow, fast = (
        run_plan(plan(line(1, 0, horizon="500 s", warm_up="0 s").replace("s1: 1.0", f"s1: {r}"))) for r in (1.0, 2.0)
    )
    n = len(slow.of(FINISH))
    assert fast.of(WORK).duration_s[:n] == pytest.approx(slow.of(WORK).duration_s[:n] / 2, abs=2.0**-20)


def test_a_repeated_task_is_that_many_performances_in_a_row():
    text = line(1, 0, horizon="300 s", warm_up="0 s").replace("mean: 1 s}", "mean: 1 s, repeat: 3}")
    work = run_plan(plan(text)).of(WORK)
    assert np.array_equal(work["k"], np.arange(len(work)))
    assert np.array_equal(work["job"], np.arange(len(work)) // 3)


def test_walks_take_distance_over_speed():
    log = run_plan(plan(CELL))
    walks = log.of(WALK)
    whole = walks.where(walks["end_s"] < log.horizon_s)
    distance = np.array(plan(CELL).distance_m)[whole["place_from"], whole["place_to"]]
    speed = np.array([1.2, 1.0, 1.2])[whole["worker"]]
    assert len(whole) > 20
    assert whole.duration_s == pytest.approx(distance / speed, abs=2.0**-20)


def test_a_worker_held_by_a_blocked_job_stays_until_it_moves():
    free, held = (
        line(2, 0, horizon="200 s", warm_up="0 s") + f"\nallocation: {{when_blocked: {rule}}}"
        for rule in ("free", "held")
    )
    waits = [run_plan(plan(text)).of(WAIT) for text in (free, held)]
    assert not (waits[0]["cause"] == JOB_BLOCKED).any()
    blocked = run_plan(plan(held)).of(BLOCKED)
    stays = waits[1].where(waits[1]["cause"] == JOB_BLOCKED)
    assert len(stays) > 10
    assert sorted(zip(stays["start_s"], stays["end_s"])) == sorted(zip(blocked["start_s"], blocked["end_s"]))


def test_full_floors_lose_jobs_only_where_told_to():
    lose = CELL.replace("every: 40 s", "every: 10 s")
    wait = lose.replace("when_full: lose", "when_full: wait")
    assert len(run_plan(plan(lose)).of(LOST)) > 50
    log = run_plan(plan(wait))
    assert not len(log.of(LOST))
    gate = log.of(HELD)
    assert (gate["station"] == -1).sum() > 50


def test_the_horizon_is_exclusive_and_open_rows_are_closed_there():
    text = line(1, 0, horizon="100 s", warm_up="0 s").replace("{dist: exponential, mean: 1 s}", "{fixed: 10 s}")
    log = run_plan(plan(text))
    assert len(log.of(FINISH)) == 9
    assert log["end_s"].max() == 100
    short = run_plan(plan(text.replace("100 s", "95 s")))
    assert short.of(WORK)["progress_to"].tolist() == [1.0] * 9 + [0.5]


def test_parallel_stations_share_jobs_by_the_shortest_queue():
    text = CELL.replace("route: [unload, [repack1, repack2], store]", "route: [unload, [repack2, repack1], store]")
    assert rows(run_plan(plan(text))) == rows(run_plan(plan(CELL)))
    work = run_plan(plan(CELL)).of(WORK)
    used = {work.names["station"][s] for s in np.unique(work["station"])}
    assert used == {"unload", "repack1", "repack2", "store"}


@pytest.mark.parametrize("rule", ["longest_queue", "nearest", "oldest_job"])
def test_each_rule_of_allocation_serves_everybody(rule):
    log = run_plan(plan(CELL.replace("rule: nearest", f"rule: {rule}")))
    assert len(log.of(FINISH)) > 60


def counted(made):
    return int(np.sum(run_plan(made).columns["kind"] == WORK))


def test_what_comes_by_itself_makes_as_many_visits_as_a_run_counts():
    made = plan(queue(horizon="3 h", every="10 s"))
    assert visits(made) == pytest.approx(counted(made), rel=0.15)


def test_no_more_than_the_bottleneck_lets_through():
    crowded = plan(queue(horizon="3 h", every="0.1 s", mean="10 s"))
    assert visits(crowded) == pytest.approx(1080, rel=0.01)


def test_a_line_that_is_never_idle_makes_about_as_many_as_its_bottleneck():
    made = plan(line(3, 5, horizon="1 h", mean="5 s"))
    assert counted(made) <= visits(made) <= 2 * counted(made)


def test_twice_the_time_is_twice_the_work():
    one, two = (plan(queue(horizon=of)) for of in ("1 h", "2 h"))
    assert simpy_s(two) == pytest.approx(2 * simpy_s(one)) and simpy_s(one) > 0


NAMES = ("saw", "press", "drill", "anvil")
PLAN = SimpleNamespace(stations=[SimpleNamespace(name=name) for name in NAMES])


def gate(*names):
    stations = [SimpleNamespace(rank=NAMES.index(name)) for name in names]
    return SimpleNamespace(stations=stations, n_stations=len(stations))


def test_an_instant_without_an_end_names_its_stations_in_order_and_each_once(monkeypatch):
    """Gates that are still moving stand in no order of their names."""
    monkeypatch.setattr(settle, "_admit", lambda floor: None)
    moving = [gate("saw", "press"), gate("drill", "saw"), gate("anvil")]
    floor = SimpleNamespace(stirred=moving, saturated=[], losing=False, dispatchers=[], free=[], now=60.0, error=0)
    dispatch(floor)
    assert floor.error == ENDLESS
    with pytest.raises(EndlessInstant, match=r"^t = 60\.0 s: .* still moving at: anvil, drill, press, saw$"):
        raise endless_instant(PLAN, floor)


BACKLOG = """
opsim: 1
name: backlog
run: {horizon: 200 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 5 s, automatic: true}, drill: {fixed: 4 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], buffer: 1}, mill: {at: hall, tasks: [drill], buffer: 1}}
products: {bar: {route: [saw, mill]}}
release: {kind: poisson, every: 2 s}
"""
ROUTES = {
    "straight on": [],
    "twice at one station": [("route: [saw, mill]", "route: [saw, saw, mill]")],
    "back to one of two": [("route: [saw, mill]", "route: [[saw, mill], [saw, mill]]")],
    "place first": [("buffer: 1}, mill", "buffer: 1, blocking: before}, mill")],
    "rework": [("at: hall, tasks: [drill], buffer: 1", "at: hall, tasks: [drill], buffer: 1, yield: 0.7, "
               "inspect: {finds: 1, then: {rework: mill}}")],
}  # fmt: skip


@pytest.mark.parametrize("edits", ROUTES.values(), ids=ROUTES)
def test_looking_at_every_claim_would_find_the_same(edits, monkeypatch):
    log, _ = plans.ran(BACKLOG, *edits)
    monkeypatch.setattr(build, "_comes_back", lambda *_: True)
    twin, _ = plans.ran(BACKLOG, *edits)
    assert all(np.array_equal(log[name], twin[name], equal_nan=True) for name in log.columns)


def test_a_queue_outside_is_not_gone_through_where_nobody_comes_back(monkeypatch):
    asked = []
    may_enter = routing.may_enter
    monkeypatch.setattr(routing, "may_enter", lambda *what: asked.append(what) or may_enter(*what))
    plans.ran(BACKLOG)
    assert not asked
    plans.ran(BACKLOG, *ROUTES["twice at one station"])
    assert asked
