from itertools import pairwise
from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made.scene import SHOWN, opened_text, run_of, scene
from plans import loaded

from opsim.layout import ways
from opsim.plan import compile_plan
from opsim.scenario.schema import Layout
from opsim.viewer.build import notes_of, scene_of
from opsim.viewer.floor import AHEAD_M, DEPTH_M, HEIGHT_M, drawn_as, floor_of
from opsim.viewer.pose import joints_m
from opsim.viewer.routes import CORNER_M, Routes, at_m, eased_heading, length_m, smooth, without_doubles, wrapped

CORNER = """
opsim: 1
name: corner
run: {horizon: 5 min, seed: 3}
layout: {places: {here: [0 m, 0 m], there: [3 m, 0 m]}}
tasks: {do: {fixed: 20 s}}
stations:
  a: {at: here, tasks: [do], buffer: 2}
  b: {at: here, tasks: [do], buffer: 2}
  c: {at: there, tasks: [do], buffer: 2, servers: 3}
products: {box: {route: [a, b, c]}}
release: {kind: saturated}
workers:
  ana: {skills: {a: 1.0}}
  ben: {skills: {b: 1.0}}
  cem: {skills: {c: 1.0}}
  dan: {like: cem}
  eva: {like: cem}
"""


def test_a_bench_stands_before_who_works_there():
    for name in ("walking_cell", "two_shift_plant"):
        run = run_of(name)
        floor = floor_of(run.plan, run.loaded.scenario.layout)
        far = AHEAD_M + DEPTH_M / 2
        for bench in floor.benches:
            x, y = floor.points_m[bench.place]
            assert (bench.x_m, bench.y_m) == pytest.approx(
                (x + far * cos(bench.facing_rad), y + far * sin(bench.facing_rad))
            )


def test_benches_stand_where_nobody_else_does():
    run = run_of("two_shift_plant")
    floor = floor_of(run.plan, run.loaded.scenario.layout)
    for bench in floor.benches:
        assert all(hypot(bench.x_m - x, bench.y_m - y) > 0.7 for x, y in floor.points_m)


def test_a_bench_is_as_high_as_its_surface_and_a_rack_has_its_levels():
    rack = "rack: {at: [4 m, 0 m], levels: {top: 1.6 m, low: 0.3 m}}"
    places = f"{{bench: {{at: [0 m, 0 m], surface: 1.1 m}}, {rack}, far: [8 m, 0 m]}}"
    stations = "{s1: {at: bench, tasks: [t]}, s2: {at: rack, tasks: [t]}, s3: {at: far, tasks: [t]}}"
    text = f"""
opsim: 1
name: heights
run: {{horizon: 5 min}}
layout: {{places: {places}}}
tasks: {{t: {{fixed: 10 s}}}}
stations: {stations}
products: {{part: {{route: [s1, s2, s3]}}}}
release: {{kind: poisson, every: 1 min}}
workers: {{ana: {{skills: {{s1: 1, s2: 1, s3: 1}}}}}}
"""
    bench, shelves, plain = floor_of(compile_plan(loaded(text)), loaded(text).scenario.layout).benches
    assert (bench.height_m, bench.levels_m) == (1.1, ())
    assert shelves.levels_m == (0.3, 1.6) and shelves.height_m > 1.6
    assert (plain.height_m, plain.levels_m) == (HEIGHT_M, ())


def test_stations_at_one_rack_are_bays_of_it_and_people_stand_before_it():
    run = run_of("rack_levels")
    floor = floor_of(run.plan, run.loaded.scenario.layout)
    bays = [bench for bench in floor.benches if bench.name in ("hip", "low", "top")]
    assert [bay.levels_m for bay in bays] == 3 * [(0.3, 0.95, 1.6)]
    assert len({(bay.facing_rad, bay.height_m, bay.width_m) for bay in bays}) == 1
    steps_m = [hypot(b.x_m - a.x_m, b.y_m - a.y_m) for a, b in pairwise(bays)]
    assert steps_m == pytest.approx(2 * [bays[0].width_m]), "one joins the next"
    x, y = floor.points_m[bays[0].place]
    far = AHEAD_M + DEPTH_M / 2
    middle = (x + far * cos(bays[1].facing_rad), y + far * sin(bays[1].facing_rad))
    assert (bays[1].x_m, bays[1].y_m) == pytest.approx(middle)
    posts = [post for post in floor.posts.values() if post.place == bays[0].place]
    assert {(post.facing_rad, post.left_m) for post in posts} == {(bays[0].facing_rad, 0.0)}
    assert all(hypot(a.buffer_m[0] - b.buffer_m[0], a.buffer_m[1] - b.buffer_m[1]) > 1.0 for a, b in pairwise(bays))


def test_two_stations_of_one_place_stand_back_to_back():
    plan = compile_plan(loaded(CORNER))
    a, b, c = floor_of(plan, loaded(CORNER).scenario.layout).benches
    assert abs(abs(a.facing_rad - b.facing_rad) - pi) < 1e-9
    assert c.width_m > a.width_m and c.capacity == 2


def test_those_at_one_place_stand_beside_each_other():
    shown = scene_of(opened_text(CORNER), scores=False)
    segments = shown.segments
    for time_s in np.linspace(1.0, 290.0, 40):
        rows = [segments.row(worker, time_s) for worker in range(5)]
        spots = np.column_stack([segments.x_m[rows], segments.y_m[rows]])
        apart_m = np.hypot(*(spots[:, None] - spots[None]).transpose(2, 0, 1)) + 9 * np.eye(5)
        assert apart_m.min() > 0.7


def test_stores_and_belts_have_their_places():
    assert [pile.name for pile in scene("two_shift_plant").piles] == ["frames", "wheels"]
    assert scene("forklift").benches


def test_a_station_is_numbered_as_it_is_drawn():
    """Benches first, then stores, then belts."""
    for name in ("two_shift_plant", "forklift"):
        plan, shown = run_of(name).plan, scene(name)
        drawn = [one.name for one in (*shown.benches, *shown.piles, *shown.belts)]
        numbers = drawn_as(plan)
        assert [drawn[number] for number in numbers[:-1]] == [station.name for station in plan.stations]
        assert numbers[-1] == -1


@pytest.mark.parametrize("name", SHOWN)
def test_segments_tile_the_window_for_everybody(name):
    shown = scene(name)
    segments = shown.segments
    for begin, end in zip(segments.first[:-1], segments.first[1:]):
        start_s, end_s = segments.start_s[begin:end], segments.end_s[begin:end]
        assert start_s[0] == shown.low_s and end_s[-1] == shown.high_s
        assert np.array_equal(start_s[1:], end_s[:-1]) and np.all(end_s > start_s)


def test_a_part_of_the_run_shows_what_the_whole_shows():
    """But for walks, of which fewer need another's body: the same joints at the same time."""
    whole, part = scene("walking_cell"), scene_of(run_of("walking_cell"), window_s=(300.0, 420.0), scores=False)
    rng, compared = np.random.default_rng(0), 0
    while compared < 20:
        worker, time_s = int(rng.integers(2)), float(rng.uniform(300.0, 420.0))
        row = whole.segments.row(worker, time_s)
        if whole.segments.way[row] < 0 and whole.segments.performance[row] >= 0:
            assert joints_m(part, worker, time_s) == pytest.approx(joints_m(whole, worker, time_s), abs=1e-9)
            compared += 1


@pytest.mark.parametrize("window_s", [(5.0, 5.0), (-1.0, 10.0), (0.0, 1e6)])
def test_a_window_outside_the_run_is_refused(window_s):
    with pytest.raises(ValueError, match="expected times in order from 0 to 600 s"):
        scene_of(run_of("walking_cell"), window_s=window_s)


def test_a_stand_in_for_walking_is_told():
    assert [topic for topic, _ in scene("repack_cell").notes if topic == "Walking"]
    assert not [topic for topic, _ in scene("walking_cell").notes if topic == "Walking"]


def test_human_effects_change_the_bodies_that_are_shown():
    """Slowed work is drawn with the postures that go with it, and stretched to the time it took."""
    text = """
opsim: 1
name: tired
run: {horizon: 5 min, seed: 3}
libraries: {bench: libraries/bench_work.npz}
layout: {places: {here: [0 m, 0 m]}}
tasks: {lift: {emulator: bench/lift}}
stations: {s: {at: here, tasks: [lift], buffer: 1}}
products: {box: {route: [s]}}
release: {kind: saturated}
workers: {ana: {skills: {s: 1.0}}}
human: {fatigue: {model: lffrm, tires_half_in: 10 min}}
"""
    run = opened_text(text)
    shown, log = scene_of(run, scores=False), run.log()
    assert np.any(log["pace_shift"] != 0)
    work = shown.segments.performance >= 0
    own_s = (shown.segments.to_s - shown.segments.from_s)[work]
    whole = own_s[:-1]
    blocks = [shown.performed.one(number) for number in shown.segments.performance[work][:-1]]
    assert whole == pytest.approx([float(block.duration_s[row]) for block, row in blocks])
    taken_s = (shown.segments.end_s - shown.segments.start_s)[work][:-1]
    assert taken_s == pytest.approx(whole, rel=1e-3)


def test_who_works_on_a_moving_line_goes_with_it():
    shown, line = scene("moving_line"), run_of("moving_line").plan.lines[0]
    segments = shown.segments
    work = np.flatnonzero((segments.state == shown.states.index("work")) & (segments.end_s - segments.start_s > 5.0))
    speed = segments.dx_m[work] / (segments.end_s - segments.start_s)[work]
    assert np.median(speed) == line.speed_m_per_s or abs(np.median(speed) - line.speed_m_per_s) < 1e-9


def test_nobody_jumps_on_a_moving_line():
    shown = scene("moving_line")
    segments = shown.segments
    for worker in range(len(shown.workers)):
        for row in range(segments.first[worker], segments.first[worker + 1] - 1):
            one, two = (joints_m(shown, worker, segments.end_s[row] + past_s) for past_s in (-1e-6, 1e-6))
            assert np.linalg.norm((one - two)[0]) < 0.1


POINTS = st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=2, max_size=5).map(
    lambda points: without_doubles([(float(x), float(y)) for x, y in points])
)
WAYS_CORNER = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])


def test_places_on_a_way():
    assert at_m(WAYS_CORNER, 1.0)[0] == pytest.approx([1, 0]) and at_m(WAYS_CORNER, 5.0)[0] == pytest.approx([4, 1])
    assert at_m(WAYS_CORNER, 99.0)[0] == pytest.approx([4, 3]) and at_m(WAYS_CORNER, -1.0)[0] == pytest.approx([0, 0])


def test_ways_along_the_axes_lead_around_benches():
    """Every one is as long; with a bench before both ends the way goes up between them."""
    layout = Layout(distance="rectilinear", places={"a": ["0 m", "0 m"], "b": ["4 m", "5 m"]})
    free, around = (Routes(ways(layout), layout, benches) for benches in ([], [(0.0, 0.77), (4.0, 0.77)]))
    assert free.points_m((0.0, 0.0), (4.0, 5.0), 0, 1) == [(0.0, 0.0), (4.0, 0.0), (4.0, 5.0)]
    assert around.points_m((0.0, 0.0), (4.0, 5.0), 0, 1) == [(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (4.0, 5.0)]


def test_ways_on_paths_pass_the_places_between():
    places = {"a": ["0 m", "0 m"], "b": ["4 m", "0 m"], "c": ["4 m", "3 m"]}
    layout = Layout(distance="paths", places=places, paths=[["a", "b", "c"]])
    found = Routes(ways(layout), layout).points_m((0.0, 0.5), (4.0, 3.0), 0, 2)
    assert found == [(0.0, 0.5), (4.0, 0.0), (4.0, 3.0)]


def test_who_walks_turns_before_and_after_a_corner():
    headings = [at_m(WAYS_CORNER, 4.0 + past)[1] for past in (-0.5, -CORNER_M / 2, 0.0, CORNER_M / 2, 0.5)]
    assert headings == pytest.approx(np.array([0, 1, 2, 3, 4]) / 4 * np.pi / 2)


@given(POINTS, st.floats(0.0, 1.0))
def test_places_and_headings_change_without_a_jump(points, share):
    way = np.array(points)
    s_m, small_m = share * length_m(points), 1e-7
    one, two = at_m(way, s_m), at_m(way, s_m + small_m)
    assert np.linalg.norm(one[0] - two[0]) <= 1.01 * small_m
    assert abs(wrapped(one[1] - two[1])) < 1e-4 or abs(abs(wrapped(one[1] - two[1])) - np.pi) < 1e-4


def test_walks_begin_and_end_as_one_stood():
    yaw = (np.pi / 2, -np.pi / 2)
    assert eased_heading(0.0, 0.0, 5.0, 5.0, yaw) == pytest.approx(np.pi / 2)
    assert eased_heading(0.0, 5.0, 0.0, 5.0, yaw) == pytest.approx(-np.pi / 2)
    assert eased_heading(0.3, 2.0, 3.0, 5.0, yaw) == 0.3
    assert eased_heading(0.3, 0.0, 5.0, 5.0, (np.nan, np.nan)) == 0.3


@given(st.floats(-50.0, 50.0))
def test_a_turn_is_taken_the_shorter_way_round(angle):
    assert abs(wrapped(angle)) <= np.pi + 1e-4
    assert np.cos(wrapped(angle)) == pytest.approx(np.cos(angle)) and np.sin(wrapped(angle)) == pytest.approx(
        np.sin(angle), abs=1e-9
    )


@pytest.mark.parametrize("angle", [np.pi, -np.pi, np.float32(np.pi), np.float32(-np.pi), 3 * np.pi])
def test_half_turns_go_to_the_left_however_they_are_rounded(angle):
    assert wrapped(float(angle)) == pytest.approx(np.pi)


def test_smooth_goes_from_0_to_1_and_stays_there():
    assert [smooth(share) for share in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]


MADE = {"source": "synthetic reach", "licence": "MIT", "n_sequences": 10, "n_workers": 4, "library": "b.npz"}


def task(name, **more):
    return {"task": name, "emulated": False, "automatic": False, **more}


def emulated(name, learned, **more):
    return task(name, **{**MADE, "emulated": True, "library_task": learned, **more})


def said(*tasks, walking=None, seed=3, **others):
    summaries = {"base": {"seed": seed, "tasks": list(tasks), **({} if walking is None else {"walking": walking})}}
    return dict(notes_of(summaries | others, 2))


def test_one_replication_is_not_taken_for_the_average():
    assert said()["Run"] == "replication 2, seed 3: one course of luck, not the average"


def test_a_source_is_named_once_with_all_that_was_learned_from_it():
    words = said(emulated("take", "reach"), emulated("give", "reach"), emulated("bend", "stoop"))["Movements"]
    assert words.endswith("from synthetic reach (20 made repetitions of 4 made-up people: nobody was recorded)")


def test_walking_and_its_licence_stand_beside_the_tasks():
    walk = {**MADE, "source": "KIT", "licence": "CC", "n_sequences": 5, "n_workers": 2, "library_task": "walk"}
    found = said(emulated("take", "reach"), walking=walk)
    assert "KIT (5 recordings of 2 people)" in found["Movements"] and found["Licences"] == "MIT; CC"


def test_times_without_a_body_are_named_and_machines_are_not_people():
    found = said(task("label"), task("cut", automatic=True), emulated("take", "reach"))
    assert found["Without movement"].startswith("label: ")


def test_nothing_is_said_of_what_is_not_there():
    assert set(said(task("cut", automatic=True))) == {"Run", "Licences"}


def test_what_two_variants_share_is_said_once():
    other = {"seed": 3, "tasks": [emulated("take", "reach"), task("label")]}
    found = said(emulated("take", "reach"), task("label"), near=other)
    assert found["Without movement"].startswith("label: ") and found["Movements"].count("synthetic") == 1
