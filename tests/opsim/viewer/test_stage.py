import numpy as np
import pytest
from made_scene import SHOWN, opened_text, run_of, scene

from opsim.viewer.build import scene_of
from opsim.viewer.pose import joints_m


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
    with pytest.raises(ValueError, match="expected times in order from 0 to 1200 s"):
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
