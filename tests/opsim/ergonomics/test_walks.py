"""Walks drawn again from the rows of a log: whose bodies went where."""

from dataclasses import replace

import numpy as np
import pytest
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.ergonomics import walking as looking
from opsim.ergonomics.trunk import trunk_exposure
from opsim.ergonomics.walking import drawable, drawn_walks, walk_again, walker, walking_exposure
from opsim.history import walks_of
from opsim.libraries import load_library
from opsim.log import WALK
from opsim.shipped import shipped_folder
from opsim.streams import BLOCK
from tests.opsim.ergonomics.bodies import STANDING
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.made_walks import MadeWalks, Walk, walking

CELL = """
opsim: 1
name: walkers
run: {horizon: 40 min, warm_up: 5 min, seed: 4, staffing: STAFFING}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [3 m, 9 m], d: [3.2 m, 9 m]}}
tasks: {cut: {dist: exponential, mean: 6 s}, glue: {fixed: 5 s}}
stations: {s1: {at: a, tasks: [cut], buffer: 3}, s2: {at: b, tasks: [glue], buffer: 3}, s3: {at: c, tasks: [cut]}}
products: {p: {route: [s1, s2, s3]}}
release: {kind: saturated}
workers:
  ana: {walk: 1 m/s, skills: {s1: 1.0, s2: 1.0}}
  ben: {walk: 1.4 m/s, skills: {s1: 1.0, s2: 1.0, s3: 1.0}}
"""
FIXED = CELL.replace("STAFFING", "fixed")
A, B, C, D = range(4)


def walk(start, end, worker=0, places=(A, B)):
    return row(WALK, start, end, worker=worker, places=places)


def walked(rows, of=None):
    of = walking(plan(FIXED)) if of is None else of
    return walking_exposure(made(rows, of), of)


def everything(found):
    return np.r_[found.exposure.seconds_by_degree.ravel(), found.exposure.degree_seconds, found.metres, found.steps]


@pytest.fixture(scope="module", params=["fixed", "redrawn"])
def run(request):
    """A plan whose workers walk, and the log of its replication 2."""
    of = walking(plan(CELL.replace("STAFFING", request.param)))
    return of, run_plan(of, 2)


# Known answers


def test_a_walk_is_measured_over_its_whole_way():
    found = walked([walk(400, 403)], walking(plan(FIXED), Still()))
    assert found.exposure.measured_s[0] == pytest.approx(3) and found.metres[0] == pytest.approx(3)
    assert found.steps[0] == 6
    assert found.exposure.degree_seconds[0] == pytest.approx(3 * 7.0, rel=1e-3)
    assert found.exposure.measured_s[1] == 0


class Still(Walk):
    """Everybody leans by 7 degrees."""

    def draw_worker(self, rng, body=None):
        return 0.0

    def sample(self, n, rng, **how):
        drawn = super().sample(n, rng, **how)
        return type(drawn)(drawn.distance_m, drawn.duration_s, drawn.n_steps, np.full(n, 7.0))


def test_a_walk_counts_as_far_as_it_lies_in_the_window():
    """Across the end of the warm-up at 300 s, and cut by the horizon at 2400 s, of 3 s each."""
    found = walked([walk(298, 301), walk(2399, 2400)])
    assert found.exposure.measured_s[0] == pytest.approx(1 + 1)
    assert found.metres[0] == pytest.approx(2) and found.steps[0] == pytest.approx(4)


def test_a_walk_too_short_to_be_drawn_is_not_measured():
    """Of 0.2 m, where the shortest is 0.5 m; the other walks of its block are."""
    found = walked([walk(400, 400.2, places=(C, D)), walk(401, 404)])
    assert found.exposure.unmeasured_s[0] == pytest.approx(0.2) and found.exposure.measured_s[0] == pytest.approx(3)
    assert walked([walk(400, 400.2, places=(C, D))]).exposure.unmeasured_s[0] == pytest.approx(0.2)


def test_who_does_not_walk_has_no_exposure():
    assert not everything(walked([])).any()


def test_walks_that_nobody_can_draw_are_told_apart():
    lengths = np.array([0.0, 0.04, 0.06, 0.6, 999.0, 1001.0, np.inf])
    assert drawable(Walk(), lengths).tolist() == [False, False, False, True, True, False, False]
    assert drawable(object(), lengths).tolist() == [False, False, True, True, True, False, False]


def test_a_walker_walks_as_the_person_he_is_and_at_no_pace_of_tasks():
    asked = []

    class Asked(Walk):
        def draw_worker(self, rng, body=None):
            asked.append((body.height_m, body.pace))
            return 0.0

    of = walking(plan(FIXED.replace("walk: 1 m/s", "walk: 1 m/s, height: 1.6 m, pace: 1.2")), Asked())
    walker(of, 0, 0)
    assert asked == [(1.6, None)]


# Laws


def test_walking_minutes_are_the_time_of_the_walking_rows(run):
    of, log = run
    found, rows = walking_exposure(log, of), log.of(WALK)
    for rank in range(2):
        in_rows_s = rows.clipped_s(*of.window_s)[rows["worker"] == rank].sum()
        assert found.exposure.measured_s[rank] == pytest.approx(in_rows_s, rel=1e-12) and in_rows_s > 60
    assert not found.exposure.unmeasured_s.any()


def test_all_walks_of_a_worker_are_drawn_block_by_block(run):
    of, log = run
    walks = walks_of(log, of)
    seen = np.concatenate([rows for rows, _ in drawn_walks(walks, of, log.replication)])
    assert seen.tolist() == list(range(walks.k.size)) and walks.k.max() > BLOCK
    for rows, block in drawn_walks(walks, of, log.replication):
        assert np.array_equal(block.distance_m[walks.k[rows] % BLOCK], walks.distance_m[rows])


def test_the_times_of_the_rows_are_distance_over_speed(run):
    of, log = run
    walks = walks_of(log, of)
    whole = walks.end_s < of.horizon_s
    speed = np.array([person.walk_m_per_s for person in of.workers])[walks.worker]
    assert np.array_equal((walks.end_s - walks.start_s)[whole], walks.whole_s[whole])
    assert np.allclose(walks.whole_s, walks.distance_m / speed, atol=2**-20)


def test_a_walk_can_be_had_again_alone(run):
    of, log = run
    walks = walks_of(log, of)
    for rows, block in drawn_walks(walks, of, log.replication):
        one = rows[len(rows) // 2]
        rank, k = int(walks.worker[one]), int(walks.k[one])
        again = walk_again(of, log.replication, rank, k, float(walks.distance_m[one]))
        assert again.duration_s == block.duration_s[k % BLOCK]
        assert np.allclose(again.decoded("positions_m", n_times=9), block[[k % BLOCK]].positions_m(n_times=9)[0])


def test_a_walk_that_cannot_be_drawn_is_refused():
    with pytest.raises(ValueError, match=r"made/walk: no walk of 0\.2 m can be drawn"):
        walk_again(walking(plan(FIXED)), 0, 0, 3, 0.2)


def test_another_worker_changes_nobody_s_walks():
    own = [walk(10 * k + 400, 10 * k + 403) for k in range(90)]
    other = [walk(10 * k + 400, 10 * k + 408, 1, (B, C)) for k in range(70)]
    alone, beside = walked(own), walked(own + other)
    assert np.array_equal(alone.exposure.seconds_by_degree[0], beside.exposure.seconds_by_degree[0])


def test_the_warm_up_changes_no_walk_after_it(monkeypatch):
    monkeypatch.setattr(looking, "LOOKED_AT", 1000)
    rows = [walk(10 * k + 100, 10 * k + 103) for k in range(90)]
    whole, late = (walked(rows, replace(walking(plan(FIXED)), warm_up_s=at)) for at in (0.0, 500.0))
    only_early = walked(rows, replace(walking(plan(FIXED)), warm_up_s=0.0, horizon_s=500.0))
    assert np.allclose(everything(whole), everything(late) + everything(only_early))


def test_who_is_drawn_anew_in_each_replication_walks_anew():
    """The lean of a worker is his own: with fixed staffing the mean over many walks is one number."""
    rows = [walk(10 * k + 400, 10 * k + 403) for k in range(190)]
    for staffing, alike in (("fixed", True), ("redrawn", False)):
        of = walking(plan(CELL.replace("STAFFING", staffing)))
        logs = [replace(made(rows, of), replication=replication) for replication in (0, 1)]
        mean = [walking_exposure(log, of).exposure.degree_seconds[0] / (3 * 190) for log in logs]
        assert (abs(mean[0] - mean[1]) < 0.6) == alike and mean[0] != mean[1]


def test_an_emulator_whose_rows_cannot_be_taken_apart_is_measured_too():
    class Together(Walk):
        def sample(self, n, rng, **how):
            return Hidden(super().sample(n, rng, **how))

    class Hidden:
        def __init__(self, drawn):
            self.duration_s, self.n_steps, self.skeleton = drawn.duration_s, drawn.n_steps, drawn.skeleton
            self.positions_m = drawn.positions_m

    rows = [walk(400, 403), walk(404, 413, places=(B, C))]
    apart, together = walked(rows), walked(rows, walking(plan(FIXED), Together()))
    assert np.allclose(everything(apart), everything(together))


def test_postures_of_another_shape_are_refused_with_the_emulator_s_name():
    class Flat(Walk):
        def sample(self, n, rng, **how):
            return FlatWalks(*vars(super().sample(n, rng, **how)).values())

    with pytest.raises(ValueError, match=r"walking \(made/walk\): FlatWalks.positions_m gave"):
        walked([walk(400, 403)], walking(plan(FIXED), Flat()))


class FlatWalks(MadeWalks):
    def positions_m(self, n_times):
        return super().positions_m(n_times)[..., :2]


def test_many_walks_are_stood_for_by_some_of_every_length():
    """Lengths of 3 and 9 m, a third of the time on the short ones; the lean of a walk scatters by 2 degrees."""
    rows = [walk(20 * k + 300, 20 * k + 303) for k in range(100)]
    rows += [walk(20 * k + 310, 20 * k + 319, places=(B, C)) for k in range(70)]
    of = walking(plan(FIXED))
    some = walked(rows, of).exposure
    assert some.measured_s[0] == pytest.approx(100 * 3 + 70 * 9)
    walks = walks_of(made(rows, of), of)
    stands = looking.stood_for(walks, walks.whole_s)
    assert (stands > 0).sum() == looking.LOOKED_AT
    short = walks.distance_m < 5
    assert stands[short].sum() == pytest.approx(300, abs=930 / looking.LOOKED_AT)


@pytest.mark.slow
def test_some_walks_stand_for_all(monkeypatch):
    """Over 12 replications: no bias, and an error of the mean of 2 degrees over the root of their number at most."""
    of = walking(plan(FIXED))
    rows = [walk(20 * k + 300, 20 * k + 303 + 6 * (k % 2), places=((A, B), (B, C))[k % 2]) for k in range(105)]
    logs = [replace(made(rows, of), replication=replication) for replication in range(12)]
    some, n = np.array([walking_exposure(log, of).exposure.degree_seconds[0] for log in logs]), looking.LOOKED_AT
    monkeypatch.setattr(looking, "LOOKED_AT", 1000)
    every = np.array([walking_exposure(log, of).exposure.degree_seconds[0] for log in logs])
    error_deg = (some - every) / (52 * 9 + 53 * 3)
    bound = 2 / np.sqrt(n)
    assert error_deg.std() < bound and abs(error_deg.mean()) < 3 * bound / np.sqrt(12)


# Off means off


def test_an_emulator_of_walking_changes_no_row_and_no_exposure_of_work(run):
    of, log = run
    without = replace(of, walking=None)
    again = run_plan(without, 2)
    assert all(np.array_equal(log[name], again[name], equal_nan=True) for name in log.columns)
    with_it, off = trunk_exposure(log, of), trunk_exposure(log, without)
    assert np.array_equal(with_it.unmeasured_s, off.unmeasured_s)


def test_the_made_walker_s_feet_stay_where_they_bear():
    """The fake itself: what pictures of it show is no accident."""
    drawn = Walk().sample(3, np.random.default_rng(0), condition={"distance_m": 4.0, "speed_m_per_s": 1.0})
    feet = drawn.positions_m(n_times=101)[
        :, :, [list(drawn.skeleton.names).index(f"{s}_toe") for s in ("left", "right")]
    ]
    bears = drawn.contact(n_times=101)
    moved = np.abs(np.diff(feet[..., 0], axis=1))
    assert np.all(moved[bears[:, :-1] & bears[:, 1:]] < 1e-12)
    assert STANDING["left_toe"][1] == feet[0, 0, 0, 1]


def test_a_walk_of_the_shipped_emulator_knows_nothing_of_the_lengths_of_others():
    model = load_library(shipped_folder() / "libraries" / "walking.npz")["walk"]
    effect = model.draw_worker(np.random.default_rng(0))
    drawn = []
    for others_m in (1.0, 9.0):
        lengths = np.r_[3.0, np.full(BLOCK - 1, others_m)]
        condition = {"distance_m": lengths, "speed_m_per_s": np.full(BLOCK, 1.2)}
        drawn.append(model.sample(BLOCK, np.random.default_rng(1), worker=effect, condition=condition)[:1])
    one, other = drawn
    assert one.duration_s[0] == other.duration_s[0]
    assert np.array_equal(one.positions_m(n_times=9), other.positions_m(n_times=9))
