import numpy as np
import pytest
from made_scene import SHOWN, run_of, scene

from opsim.ergonomics.redraw import performance_again
from opsim.log import SETUP, WORK
from opsim.viewer.pose import body_at, joints_m
from opsim.viewer.segments import is_gone
from opsim.viewer.skeletons import turned


def moments(shown, n, seed=0):
    """(worker, time) at random."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        yield int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))


@pytest.mark.parametrize("name", SHOWN)
def test_people_are_where_the_emulator_has_them(name):
    """Any row of work again by its name, and its joints turned and shifted: those of the scene."""
    run, shown = run_of(name), scene(name)
    log, segments, rng = run.log(), shown.segments, np.random.default_rng(1)
    known = [rank for rank, (_, known) in enumerate(shown.tasks) if known]
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & np.isin(log["task"], known) & (log["worker"] >= 0))
    rows = rows[log["end_s"][rows] > log["start_s"][rows]]
    for row in rng.choice(rows, 8, replace=False).tolist():
        piece, share = performance_again(log, run.plan, row), rng.uniform(0.05, 0.95)
        at = segments.row(int(log["worker"][row]), piece.start_s + share * (piece.end_s - piece.start_s))
        own_s = (piece.progress_from + share * (piece.progress_to - piece.progress_from)) * piece.duration_s
        own = piece.positions_m(times_s=np.array([own_s]))[0]
        meant = turned(own, segments.yaw_rad[at]) + np.array([segments.x_m[at], segments.y_m[at], 0.0])
        found = joints_m(shown, int(log["worker"][row]), piece.start_s + share * (piece.end_s - piece.start_s))
        assert found == pytest.approx(meant, abs=1e-6)


@pytest.mark.parametrize("name", SHOWN)
def test_nobody_is_under_the_floor_or_over_the_roof(name):
    for worker, time_s in moments(scene(name), 25):
        joints = joints_m(scene(name), worker, time_s)
        # at 0.97 m was the lowest of squats' highest joints in recordings; new people may bend lower, by a t of so few
        assert joints is None or (joints[:, 2].min() > -0.02 and 0.6 < joints[:, 2].max() < 2.6)


def test_who_is_off_is_not_on_the_floor():
    shown = scene("two_shift_plant")
    late = [name for name, _ in shown.workers].index("kim")
    assert joints_m(shown, late, 3600.0) is None
    assert is_gone(shown.segments.state[shown.segments.row(late, 3600.0)])


def straight_strides(shown, n):
    """(worker's row, joints before and after 20 ms, own joints so, which feet bear) on straight stretches of walks."""
    segments, ways, rng = shown.segments, shown.ways, np.random.default_rng(2)
    rows = np.flatnonzero((segments.way >= 0) & (segments.end_s - segments.start_s > 1.5))
    for row in rng.permutation(rows[np.diff(ways.first)[segments.way[rows]] == 2])[:n].tolist():
        start_s, end_s = segments.start_s[row], segments.end_s[row]
        at_s = rng.uniform(start_s + 0.4, end_s - 0.45) + np.array([0.0, 0.02])
        share = (at_s - start_s) / (end_s - start_s)
        own_s = segments.from_s[row] + share * (segments.to_s[row] - segments.from_s[row])
        block, place = shown.performed.one(segments.performance[row])
        some = block[np.array([place])]
        bears = some.contact(times_s=own_s[None])[0].all(axis=0)
        shown_m = np.array([body_at(shown, row, t).joints_m for t in at_s])
        yield some.skeleton.names, shown_m, some.positions_m(times_s=own_s[None])[0], bears


def test_feet_that_bear_hold_still_on_straight_ways():
    """The ankle, or the toe once the heel is up, moves by 6 cm a second at most: no more than the emulator's own."""
    slides = []
    for names, shown_m, own_m, bears in straight_strides(scene("two_shift_plant"), 60):
        for side in (side for side, on in zip(("left", "right"), bears) if on):
            foot = [names.index(f"{side}_{joint}") for joint in ("ankle", "toe")]
            on_floor, own = (np.linalg.norm(np.diff(m[:, foot, :2], axis=0)[0], axis=-1) for m in (shown_m, own_m))
            assert on_floor == pytest.approx(own, abs=2e-4)
            slides.append(on_floor.min() / 0.02)
    assert len(slides) > 20 and max(slides) < 0.06


@pytest.mark.parametrize("name", ["walking_cell", "two_shift_plant"])
def test_nobody_jumps(name):
    """From one segment to the next the root stays within a hand's breadth, though feet end a task where they end."""
    shown = scene(name)
    segments = shown.segments
    for worker in range(len(shown.workers)):
        rows = np.arange(segments.first[worker], segments.first[worker + 1] - 1)
        for row in np.random.default_rng(worker).choice(rows, min(12, rows.size), replace=False).tolist():
            one, two = body_at(shown, row, segments.end_s[row]), body_at(shown, row + 1, segments.start_s[row + 1])
            if one is not None and two is not None:
                assert np.linalg.norm((one.root_m - two.root_m)[:2]) < 0.15


def test_who_stands_eases_in_and_out():
    """At the edges of standing the posture is that of the work beside it."""
    shown = scene("walking_cell")
    segments, edges = shown.segments, 0
    for row in np.flatnonzero((segments.performance[1:-1] < 0) & (segments.performance[2:] >= 0))[:20] + 1:
        if row + 1 in segments.first:
            continue
        before = body_at(shown, row, segments.end_s[row] - 1e-9).joints_m
        after = body_at(shown, row + 1, segments.start_s[row + 1]).joints_m
        assert before == pytest.approx(after, abs=1e-5)
        edges += 1
    assert edges
