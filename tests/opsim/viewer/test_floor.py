from math import cos, hypot, pi, sin

import numpy as np
import pytest
from made_scene import opened_text, run_of, scene
from plans import loaded

from opsim.plan import compile_plan
from opsim.viewer.build import scene_of
from opsim.viewer.floor import AHEAD_M, DEPTH_M, drawn_as, floor_of

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
