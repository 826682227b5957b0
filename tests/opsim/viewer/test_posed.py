import numpy as np
import pytest
from made.scene import SHOWN, run_of, scene

from opsim.ergonomics.redraw import performance_again
from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.day import fold
from opsim.libraries import load_library
from opsim.log import SETUP, WORK
from opsim.shipped import shipped_folder
from opsim.viewer.playback import Collected, is_of_coefficients, travels_m
from opsim.viewer.pose import body_at, joints_m
from opsim.viewer.scores import rula
from opsim.viewer.segments import is_gone
from opsim.viewer.skeletons import turned

QUICK = ("walking_cell", "kitting", "two_shift_plant")
SCENES = pytest.mark.parametrize(
    "name", [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in SHOWN]
)
"""Those that ``make test`` looks at have walks, movements that lead away from the bench, and shifts."""


def moments(shown, n, seed=0):
    """(worker, time) at random."""
    rng = np.random.default_rng(seed)
    for _ in range(n):
        yield int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))


@SCENES
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


@SCENES
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


@pytest.mark.parametrize("name", ["walking_cell", pytest.param("two_shift_plant", marks=pytest.mark.slow)])
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


def drawn(library, task, **condition):
    model = load_library(shipped_folder() / "libraries" / library)[task]
    return model.sample(5, np.random.default_rng(0), condition=condition or None)


def test_whose_paths_are_quickly_made_is_told_by_the_model():
    assert is_of_coefficients(drawn("bench_work.npz", "stoop"))
    assert not is_of_coefficients(drawn("walking.npz", "walk", distance_m=3.0))


def test_each_performance_that_leads_somewhere_has_its_own_end():
    some, found = drawn("bench_work.npz", "carry"), Collected()
    found.add("carry", "carry", some[:2])
    found.add("carry", "carry", some[2:])
    path = some.path(n_times=2)
    assert travels_m(found.close()) == pytest.approx(path[:, 1, :2] - path[:, 0, :2])
    assert np.ptp(path[:, 1, 0]) > 0.01


@pytest.mark.parametrize(
    "name", [*(pytest.param(name, marks=pytest.mark.slow) for name in ("kitting", "two_shift_plant")), "walking_cell"]
)
def test_nobody_is_ever_outside_of_what_is_framed(name):
    shown = scene(name)
    west, south, east, north = shown.reach_m
    rng, seen = np.random.default_rng(3), 0
    for _ in range(150):
        worker, time_s = int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))
        joints = joints_m(shown, worker, time_s)
        if joints is not None:
            x, y = joints[0, :2]
            assert west - 0.6 < x < east + 0.6 and south - 0.6 < y < north + 0.6
            seen += 1
    assert seen > 20


def test_where_a_task_leads_away_from_the_bench_is_framed_too():
    """Kits are fetched three metres from the bench, where no place is."""
    south = min(y for _, _, y in scene("kitting").places)
    assert scene("kitting").reach_m[1] < south - 2.5


class Kept:
    """All frames with their scores, for a naive twin."""

    def __init__(self):
        self.frames = []

    def add(self, frames, scores: Scores):
        for k in range(len(frames)):
            self.frames.append((frames.worker, frames.start_s[k], frames.end_s[k], *scores.rula[k].tolist()))


def test_scores_are_those_of_the_frame_there_is_at_each_moment():
    from dataclasses import replace

    run, low_s, high_s = run_of("walking_cell"), 360.0, 420.0
    found, kept = rula(run.log(), run.plan, low_s, high_s), Kept()
    options = replace(run.plan.ergonomics, rate_hz=4.0)
    fold(run.log(), replace(run.plan, warm_up_s=low_s, horizon_s=high_s, ergonomics=options), [kept])
    assert found.shape == (2, 240) and (found > 0).mean() > 0.5
    for worker in range(2):
        for i in range(0, 240, 3):
            at_s = low_s + (i + 0.5) / 4
            here = [
                (low, high) for w, start_s, end_s, low, high in kept.frames if w == worker and start_s <= at_s < end_s
            ]
            meant = here[0][0] | here[0][1] << 4 if here and here[0][0] > 0 else 0
            assert found[worker, i] == meant


def test_without_any_posture_there_are_no_scores():
    run = run_of("serial_line", 300.0)
    assert rula(run.log(), run.plan, 0.0, 300.0) is None
    assert isinstance(rula(run_of("walking_cell").log(), run_of("walking_cell").plan, 0.0, 60.0), np.ndarray)
