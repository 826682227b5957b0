"""The body behind any row: pieces of one performance hang together, and together they are the whole."""

from dataclasses import replace
from importlib.metadata import EntryPoint
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from plans import loaded, ran

from opsim.clock import on_grid
from opsim.engine.floor.run import run_plan
from opsim.ergonomics import trunk as bodies
from opsim.ergonomics.angles import CANONICAL
from opsim.ergonomics.redraw import drawn_again, performance_again, pieces_in_window
from opsim.ergonomics.trunk import trunk_exposure
from opsim.history import BY_ANOTHER, HANDED_OVER, RESTARTED, RESUMED, job_pieces
from opsim.log import WAIT, WORK
from opsim.plan import compile_plan
from opsim.plugins.guard import Found, GuardedModel
from opsim.problems import PluginError
from opsim.streams import BLOCK
from tests.opsim.ergonomics.bodies import standing
from tests.opsim.ergonomics.made_work import BEND, COOK, COUNT, Bending, Bends, BendsApart, Skeleton, made_plan
from tests.opsim.kpi.made_logs import made, work

MOVES = """
opsim: 1
name: moves
run: {horizon: 12 min, warm_up: 3 min, seed: 3, staffing: STAFFING}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  lunge: {emulator: moves/side_lunge, repeat: 2}
  label: {dist: lognormal, mean: 6 s, cv: 0.3, between_share: 0.5}
stations: {s1: {at: a, tasks: [squat, lunge, label], servers: 2, buffer: 1}}
products: {p: {route: [s1]}}
release: {kind: saturated}
workers: {ana: {skills: {s1: 1.1}}, ben: {height: 1.9 m, skills: {s1: 0.8}}}
"""


def bend(start, end, *, worker=0, k=0, progress=(0.0, 1.0), task=BEND):
    return work(start, end, 0, worker=worker, k=k, progress=progress, task=task)


def exposure(rows, plan=None):
    plan = made_plan() if plan is None else plan
    return trunk_exposure(made(rows, plan), plan)


def everything(found):
    return np.r_[found.seconds_by_degree.ravel(), found.degree_seconds, found.unmeasured_s]


@pytest.fixture(scope="module", params=["fixed", "redrawn"])
def run(request):
    """A plan with shipped movements, and the log of its replication 2."""
    plan = compile_plan(loaded(MOVES.replace("STAFFING", request.param)))
    return plan, run_plan(plan, 2)


# Known answers


def test_who_bends_evenly_to_90_degrees_and_back_spends_a_third_beyond_60_and_seven_ninths_beyond_20():
    found = exposure([bend(0, 9)])
    assert found.beyond_s(60).tolist() == pytest.approx([3, 0], abs=0.02)
    assert found.beyond_s(20).tolist() == pytest.approx([7, 0], abs=0.02)
    assert found.degree_seconds[0] == pytest.approx(45 * 9, rel=1e-3)
    assert found.measured_s.tolist() == pytest.approx([9, 0]) and found.unmeasured_s.tolist() == [0, 0]


def test_who_is_quicker_goes_through_the_same_postures_in_less_time():
    slow, quick = exposure([bend(0, 9)]), exposure([bend(0, 6, worker=1)])
    assert np.allclose(quick.seconds_by_degree[1], slow.seconds_by_degree[0] * 6 / 9)


@pytest.mark.parametrize(
    ("progress", "beyond_60"), [((0.0, 0.5), 1 / 3), ((0.0, 1 / 3), 0), ((1 / 3, 2 / 3), 1), ((0.6, 0.8), 1 / 3)]
)
def test_a_piece_is_looked_at_where_its_progress_lies(progress, beyond_60):
    found = exposure([bend(100, 106, progress=progress)])
    assert found.beyond_s(60)[0] == pytest.approx(6 * beyond_60, abs=0.05)


def test_work_handed_over_is_the_second_worker_s_own_performance_from_there_on():
    plan = made_plan(Bending(depth_deg=(90.0, 0.0) + (0.0,) * (BLOCK - 2)))
    found = exposure([bend(0, 4.5, progress=(0, 0.5), k=0), bend(4.5, 9, worker=1, progress=(0.5, 1), k=1)], plan)
    assert found.beyond_s(60).tolist() == pytest.approx([1.5, 0], abs=0.02)
    assert found.measured_s.tolist() == pytest.approx([4.5, 4.5])


def test_each_performance_has_its_own_postures():
    depths = np.linspace(0, 110, BLOCK)
    rows = [bend(9 * k, 9 * k + 9, k=k) for k in range(BLOCK)]
    expected = sum(9 * max(0, 1 - 60 / depth) for depth in depths[1:])
    assert exposure(rows, made_plan(Bending(tuple(depths)))).beyond_s(60)[0] == pytest.approx(expected, rel=0.005)


def test_only_the_part_in_the_window_counts():
    plan = made_plan(warm_up_s=4.5, horizon_s=20.0)
    found = exposure([bend(0, 9), bend(17, 26, k=1)], plan)
    assert found.measured_s[0] == pytest.approx(4.5 + 3)
    assert found.beyond_s(60)[0] == pytest.approx(1.5, abs=0.02)
    assert exposure([bend(0, 4.5)], plan).measured_s[0] == 0


def test_a_time_without_a_body_is_not_measured_and_an_automatic_one_is_nobody_s():
    found = exposure([bend(0, 5, task=COUNT), bend(5, 14), work(14, 19, 0, worker=-1, task=COOK, k=0)])
    assert found.unmeasured_s.tolist() == [5, 0] and found.measured_s[0] == pytest.approx(9)


def test_a_body_without_the_joints_of_a_trunk_is_not_measured():
    skeleton = Skeleton(tuple(name.replace("pelvis", "root") for name in CANONICAL))
    found = exposure([bend(0, 9)], made_plan(Bending(skeleton=skeleton)))
    assert found.unmeasured_s[0] == 9 and found.measured_s[0] == 0


def test_postures_whose_hips_are_one_above_the_other_are_not_measured():
    class Rolls(BendsApart):
        def positions_m(self, n_times):
            found = np.repeat(super().positions_m(n_times)[:, :1] * 0 + standing(), n_times, axis=1)
            hips = [CANONICAL.index(f"{side}_hip") for side in ("left", "right")]
            found[:, : n_times // 2, hips] = [[0, 0, 1.05], [0, 0, 0.85]]
            return found

    found = exposure([bend(0, 9)], made_plan(Bending(kind=Rolls)))
    assert found.unmeasured_s[0] == pytest.approx(4.5, abs=0.2)
    assert found.unmeasured_s[0] + found.measured_s[0] == pytest.approx(9)


def test_a_trunk_that_goes_over_the_back_is_never_counted_between():
    class Over(BendsApart):
        course = staticmethod(lambda share: 170.0 + 20.0 * share)

    found = exposure([bend(0, 9)], made_plan(Bending(kind=Over)))
    spent = found.seconds_by_degree[0]
    assert spent[340:].sum() + spent[:20].sum() >= 9 - 1e-9 and spent[350:].sum() == pytest.approx(4.5, abs=0.05)


def test_no_work_is_no_exposure():
    assert not everything(exposure([])).any()


# Laws


def test_pieces_add_up_to_the_whole():
    rng = np.random.default_rng(2)
    cuts = np.r_[0.0, np.sort(rng.random(5)), 1.0]
    pieces = [bend(9 * a + 30 * i, 9 * b + 30 * i, progress=(a, b)) for i, (a, b) in enumerate(pairwise(cuts))]
    assert np.allclose(everything(exposure(pieces)), everything(exposure([bend(0, 9)])), atol=1e-9)


def test_windows_add_up():
    rows = [bend(20 * i, 20 * i + 9, k=i) for i in range(100)]
    parts = [exposure(rows, made_plan(warm_up_s=a, horizon_s=b)) for a, b in ((0.0, 777.0), (777.0, 3600.0))]
    assert np.allclose(sum(everything(part) for part in parts), everything(exposure(rows)), atol=1e-9)


def test_performances_that_cannot_be_taken_apart_are_measured_alike(monkeypatch):
    depths = tuple(np.linspace(0, 100, BLOCK))
    rows = [bend(20 * k, 20 * k + 9, k=k) for k in (3, 7, 50, 70, 129)]
    found = [exposure(rows, made_plan(Bending(depths, kind))) for kind in (Bends, BendsApart)]
    assert np.allclose(everything(found[0]), everything(found[1]), atol=1e-9)
    monkeypatch.setattr(bodies, "AT_ONCE", 1)
    few = [exposure(rows, made_plan(Bending(depths, kind))) for kind in (Bends, BendsApart)]
    assert np.allclose(everything(few[0]), everything(found[0])) and np.allclose(
        everything(few[1]), everything(found[0])
    )


def test_workers_together_are_the_sum_of_each():
    found = exposure([bend(0, 9), bend(0, 7, worker=1)])
    together = found.together()
    assert together.beyond_s(60)[0] == pytest.approx(found.beyond_s(60).sum())
    assert together.measured_s[0] == pytest.approx(16)


def test_postures_of_another_shape_are_refused_with_the_task():
    class Flat(BendsApart):
        def positions_m(self, n_times):
            return super().positions_m(n_times)[..., :2]

    with pytest.raises(
        ValueError, match=r"task bend: Flat.positions_m gave \(1, 91, 21, 2\), expected \(1, 91, 21, 3\)"
    ):
        exposure([bend(0, 9)], made_plan(Bending(kind=Flat)))


def test_postures_that_a_plug_in_cannot_give_are_its_own_mistake():
    class Breaks(BendsApart):
        def positions_m(self, n_times):
            raise KeyError("hand")

    found = Found(EntryPoint("bends", "somebody:bends", "opsim.emulators"))
    with pytest.raises(
        PluginError, match=r"plug-in .bends. of .* failed as it gave the postures of bend: KeyError: 'hand'"
    ):
        exposure([bend(0, 9)], made_plan(GuardedModel(found, Bending(kind=Breaks))))


# The draws behind a run


def test_what_is_drawn_again_is_what_was_drawn(run):
    plan, log = run
    counted = 0
    for block, pieces in drawn_again(pieces_in_window(log, plan), log.replication, plan):
        drawn_s = np.asarray(block.duration_s)[pieces.k % BLOCK]
        rating = plan.workers[pieces.worker[0]].rating[0]
        whole = (pieces.progress_from == 0) & (pieces.progress_to == 1)
        took_s = [on_grid(seconds / rating) for seconds in drawn_s[whole]]
        assert pieces.seconds[whole].tolist() == took_s
        counted += whole.sum()
    assert counted > 200


def test_work_is_either_measured_or_not(run):
    plan, log = run
    found = trunk_exposure(log, plan)
    low, high = plan.window_s
    rows = log.where((log["kind"] == 0) & (log["worker"] >= 0))
    for rank in range(2):
        worked_s = rows.clipped_s(low, high)[rows["worker"] == rank].sum()
        assert found.measured_s[rank] + found.unmeasured_s[rank] == pytest.approx(worked_s)
        label = (rows["worker"] == rank) & (rows["task"] == 0)
        assert found.unmeasured_s[rank] == pytest.approx(rows.clipped_s(low, high)[label].sum())


def test_another_worker_changes_nobody_s_postures():
    """Rows of ana alone, and beside rows of ben."""
    depths = tuple(np.linspace(0, 100, BLOCK))
    plan = made_plan(Bending(depths))
    own, other = (
        [bend(20 * k, 20 * k + 9, k=k) for k in range(9)],
        [bend(20 * k, 20 * k + 7, worker=1, k=k) for k in range(9)],
    )
    alone, beside = exposure(own, plan), exposure(own + other, plan)
    assert np.array_equal(alone.seconds_by_degree[0], beside.seconds_by_degree[0])


def test_bones_hung_one_from_the_other_give_the_angles_of_positions(run):
    plan, log = run
    for block, _ in drawn_again(pieces_in_window(log, plan), log.replication, plan):
        if block.skeleton is not None:
            rows = [0, 5, 63]
            quick = bodies.flexion_rad(block, rows)
            seam = SimpleNamespace(positions_m=block.positions_m, duration_s=block.duration_s, skeleton=block.skeleton)
            assert np.allclose(quick, bodies.flexion_rad(seam, rows), atol=1e-9)


def test_ten_postures_a_second_are_as_good_as_fifty(run, monkeypatch):
    plan, log = run
    coarse = trunk_exposure(log, plan)
    monkeypatch.setattr(bodies, "RATE_HZ", 50.0)
    fine = trunk_exposure(log, plan)
    for degrees in (20, 40):
        assert coarse.beyond_s(degrees).sum() == pytest.approx(fine.beyond_s(degrees).sum(), rel=0.01)
    assert coarse.degree_seconds.sum() == pytest.approx(fine.degree_seconds.sum(), rel=1e-3)


def test_a_replaced_model_is_the_one_that_is_looked_at(run):
    plan, log = run
    upright = replace(plan, tasks=tuple(replace(task, model=Bending((0.0,) * BLOCK)) for task in plan.tasks))
    found = trunk_exposure(log, upright)
    assert found.beyond_s(1).sum() == 0 and found.unmeasured_s.sum() == 0


FLOOR = """
opsim: 1
name: pieces
run: {start: Mon 06:00, horizon: 30 min, seed: 4}
layout: {places: {here: [0 m, 0 m]}}
libraries: {moves: libraries/public_movements.npz}
shifts: {day: {from: 06:00, to: 14:00, at_break: RULE, breaks: {BREAKS}}}
tasks: {lift: {emulator: moves/deep_squat}}
stations: {a: {at: here, tasks: [lift], buffer: 1}}
products: {p: {route: [a]}}
release: {kind: saturated}
workers: {ana: {shift: day, skills: {a: 1.0}}, ben: {skills: {a: 0.8}}}
"""
BREAKS = ", ".join(f"b{i}: {{at: 06:{2 * i + 1:02d}, lasts: 1 min}}" for i in range(14))


@pytest.fixture(scope="module", params=["resume", "resume_any", "restart"])
def again_run(request):
    return request.param, *ran(FLOOR.replace("RULE", request.param).replace("BREAKS", BREAKS))


def test_where_one_piece_ends_the_next_one_begins(again_run):
    """The same body where the same worker goes on; another one's own, at the same progress, where he took over."""
    rule, log, plan = again_run
    pieces = job_pieces(log)
    seen = 0
    for at in np.flatnonzero(np.isin(pieces.fate, (RESUMED, BY_ANOTHER, HANDED_OVER, RESTARTED))):
        one, rest = (performance_again(log, plan, int(pieces.row[i])) for i in (at, at + 1))
        if pieces.fate[at] == RESUMED:
            assert np.abs(one.positions_m(n_times=9)[-1] - rest.positions_m(n_times=9)[0]).max() < 1e-10
            assert (one.k, one.duration_s, one.number) == (rest.k, rest.duration_s, rest.number)
        elif pieces.fate[at] == RESTARTED:
            assert rest.progress_from == 0 and (rest.worker, rest.k) != (one.worker, one.k)
        else:
            assert rest.progress_from == one.progress_to and rest.worker != one.worker
        seen += 1
    assert seen >= 3, rule


def test_the_seconds_of_a_piece_are_its_share_of_the_whole(again_run):
    _, log, plan = again_run
    for row in np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0))[:40].tolist():
        piece = performance_again(log, plan, row)
        seconds = (piece.progress_to - piece.progress_from) * piece.duration_s
        assert seconds == pytest.approx(piece.end_s - piece.start_s, abs=3e-6)


def test_a_row_without_work_has_no_performance(again_run):
    _, log, plan = again_run
    row = int(np.flatnonzero(log["kind"] == WAIT)[0])
    with pytest.raises(ValueError, match=f"row {row} is no work of a worker"):
        performance_again(log, plan, row)


@pytest.mark.parametrize("cuts", [(0.5,), (0.1, 0.4, 0.8)])
def test_pieces_bend_as_much_as_the_whole(cuts):
    plan = made_plan()
    whole = trunk_exposure(made([work(0, 9, 0, worker=0, k=0, task=BEND)], plan), plan)
    edges = [0.0, *cuts, 1.0]
    rows = [
        work(100 * i + 9 * a, 100 * i + 9 * b, 0, worker=0, k=0, task=BEND, progress=(a, b))
        for i, (a, b) in enumerate(pairwise(edges))
    ]
    parts = trunk_exposure(made(rows, plan), plan)
    assert parts.seconds_by_degree == pytest.approx(whole.seconds_by_degree, abs=1e-9)


def test_who_takes_over_bends_through_his_own_second_half():
    plan = made_plan()
    rows = [work(0, 4.5, 0, worker=0, k=0, task=BEND, progress=(0, 0.5))]
    rows += [work(5, 9.5, 0, worker=1, k=0, task=BEND, progress=(0.5, 1))]
    found = trunk_exposure(made(rows, plan), plan)
    assert found.beyond_s(60)[:2] == pytest.approx([1.5, 1.5], rel=0.01)
