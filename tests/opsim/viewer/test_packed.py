import base64
import gzip
import json
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from made.scene import SHOWN, packed_scene, run_of, scene
from page_twin import Twin

from opsim.libraries import load_library
from opsim.log import QUEUE, STOCK, WORK, WORKER_KINDS
from opsim.report.page import policy
from opsim.shipped import shipped_folder
from opsim.subjects.stations.plan import STATION, STORE
from opsim.viewer.build import scene_of
from opsim.viewer.frame_codec import between, chosen, control_points, folded, frames_of, pack_frames, second_differences
from opsim.viewer.playback import rows_of
from opsim.viewer.pose import joints_m
from opsim.viewer.scene import Drawn
from opsim.viewer.skeletons import DTYPES, Columns, unpacked_column, unpacked_columns
from opsim.viewer.write import LEVEL, packed, page_script, write_replay

QUICK = ("walking_cell",)
"""The scene that ``make test`` looks at; the others take long."""


def quickly(*names):
    """Cases of which ``make test`` runs those that are quick."""
    return [name if name in QUICK else pytest.param(name, marks=pytest.mark.slow) for name in names]


@pytest.mark.parametrize("name", quickly(*SHOWN))
def test_the_page_shows_what_the_emulators_say(name):
    """From the packed columns alone, at random times of random people: within 2 mm at every joint, mostly far less."""
    shown, twin = scene(name), Twin(*packed_scene(name))
    rng, errors_m = np.random.default_rng(4), []
    for _ in range(200):
        worker, time_s = int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))
        meant, found = joints_m(shown, worker, time_s), twin.joints_m(worker, time_s)
        assert (meant is None) == (found is None)
        if meant is not None:
            errors_m.append(np.linalg.norm(meant - found, axis=1).max())
    assert len(errors_m) > 30 and max(errors_m) < 2e-3 and np.mean(np.array(errors_m) < 1e-3) > 0.95


@pytest.mark.parametrize("name", quickly("repack_cell", "walking_cell"))
def test_a_second_of_movement_takes_less_than_a_kilobyte(name):
    """Compressed as the page is: 670 and 800 bytes."""
    meta, data = packed_scene(name)
    columns = unpacked_columns(meta["columns"], data)
    moving_s = sum(columns[model["columns"]["duration_s"]].sum() for model in meta["models"])
    assert moving_s > 400 and len(gzip.compress(data, LEVEL)) < 1000 * moving_s


def test_the_same_run_gives_the_same_bytes():
    run, window_s = run_of("walking_cell"), (200.0, 320.0)
    (one, first), (other, second) = (packed(scene_of(run, window_s=window_s)) for _ in range(2))
    assert first == second and json.dumps(one) == json.dumps(other)


@pytest.mark.slow
def test_what_is_told_is_plain_json_and_every_column_is_there():
    meta, data = packed_scene("two_shift_plant")
    assert json.loads(json.dumps(meta, allow_nan=False)) == meta
    ends = [offset + count * int(dtype[1]) for dtype, offset, count in meta["columns"].values()]
    assert max(ends) <= len(data)
    assert all(name in meta["columns"] for model in meta["models"] for name in model["columns"].values())
    assert [state["name"] for state in meta["states"]][:3] == ["work", "walk", "wait"]
    assert {model["codec"] for model in meta["models"]} == {"frames"}


@pytest.mark.parametrize("name", quickly("two_shift_plant", "forklift", "walking_cell"))
def test_a_segment_names_station_and_task_as_the_log_has_them(name):
    """Stores and conveyors lie between the stations of a plan, not between those that the page lists."""
    run, (meta, data) = run_of(name), packed_scene(name)
    log, columns = run.log(), unpacked_columns(meta["columns"], data)
    stood = [one["name"] for kind in ("stations", "stores", "belts") for one in meta[kind]]
    tasks = [task["name"] for task in meta["tasks"]]
    named = 0
    for row in np.random.default_rng(5).integers(columns["seg_start_s"].size, size=200).tolist():
        worker, at_s = np.searchsorted(columns["seg_first"], row, side="right") - 1, columns["seg_start_s"][row]
        now = (log["worker"] == worker) & (log["start_s"] <= at_s) & (log["end_s"] > at_s)
        at = np.flatnonzero(now & np.isin(log["kind"], WORKER_KINDS))[0]
        meant = [_named(run.plan.stations, log["station"][at]), _named(run.plan.tasks, log["task"][at])]
        shown = columns["seg_station"][row], columns["seg_task"][row]
        assert [names[k] if k >= 0 else None for names, k in zip((stood, tasks), shown)] == meant
        named += meant[0] is not None
    assert named > 50


def _named(ones, rank):
    return ones[rank].name if rank >= 0 else None


def column_of(dtype):
    return st.tuples(st.just(dtype), arrays(f"<{dtype}", st.integers(0, 20)))


COLUMN = st.sampled_from(DTYPES).flatmap(column_of)


@given(st.lists(COLUMN, max_size=6))
def test_columns_come_back_as_they_went_in(given):
    columns = Columns()
    for number, (dtype, values) in enumerate(given):
        columns.add(f"c{number}", dtype, values)
    data = columns.close()
    found = unpacked_columns(columns.table, data)
    for number, (_, values) in enumerate(given):
        assert found[f"c{number}"].tobytes() == values.tobytes()
    assert all(offset % 8 == 0 for _, offset, _ in columns.table.values()) and len(data) % 8 == 0


def test_the_low_bytes_come_first():
    columns = Columns()
    columns.add("a", "u2", np.array([0x0102, 0x0304]))
    assert columns.close()[:4] == bytes([2, 4, 1, 3])
    assert unpacked_column(bytes([2, 4, 1, 3]), "u2", 0, 2).tolist() == [0x0102, 0x0304]


def test_a_number_that_does_not_fit_is_refused():
    with pytest.raises(ValueError, match="column a: 0 to 70000 do not fit into u2"):
        Columns().add("a", "u2", np.array([0, 70_000]))


def test_a_column_is_added_once():
    columns = Columns()
    columns.add("a", "u1", np.zeros(3))
    with pytest.raises(ValueError, match="column a"):
        columns.add("a", "u1", np.zeros(3))


def level(courses, subject, name, time_s):
    begin, end = courses.first[subject], courses.first[subject + 1]
    at = begin + np.searchsorted(courses.at_s[begin:end], time_s, side="right") - 1
    return courses.columns[name][at]


@pytest.mark.parametrize("name", ["walking_cell", "two_shift_plant"])
def test_queues_stores_and_work_are_the_rows_that_are_open(name):
    run, shown = run_of(name), scene(name)
    log, plan = run.log(), run.plan
    stations, stores = ([k for k, one in enumerate(plan.stations) if one.kind == kind] for kind in (STATION, STORE))
    for time_s in np.random.default_rng(0).uniform(shown.low_s, shown.high_s, 30):
        there = (log["start_s"] <= time_s) & (log["end_s"] > time_s) & (log["job"] >= 0)
        for subject, rank in enumerate(stations):
            here = there & (log["station"] == rank)
            assert level(shown.stations, subject, "queue", time_s) == (here & (log["kind"] == QUEUE)).sum()
            assert (level(shown.stations, subject, "busy", time_s) > 0) == (here & np.isin(log["kind"], [WORK])).any()
        for subject, rank in enumerate(stores):
            lies = there & (log["station"] == rank) & (log["kind"] == QUEUE) & (log["cause"] == STOCK)
            assert level(shown.stores, subject, "level", time_s) == lies.sum()


def test_a_station_at_work_says_so():
    shown = scene("walking_cell")
    busy, state = shown.stations.columns["busy"], shown.stations.columns["state"]
    assert np.array_equal(busy > 0, state == shown.station_states.index("work"))


class Nodding:
    """Somebody's emulator that tells no more than it must: joints of a body of three, and cannot be taken apart."""

    class skeleton:
        names = ("pelvis", "neck", "head")

    def __init__(self, n):
        self.duration_s = np.linspace(1.0, 2.0, n)

    def positions_m(self, times_s=None, n_times=101):
        angle = 0.3 * np.sin(3 * np.asarray(times_s) + np.arange(len(self.duration_s))[:, None])
        pelvis = np.stack([0.1 * angle, 0 * angle, 0.9 + 0 * angle], axis=-1)
        neck = pelvis + np.array([0.0, 0.0, 0.5])
        head = neck + 0.2 * np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)
        return np.stack([pelvis, neck, head], axis=2)


@given(arrays(np.float64, (9, 5), elements=st.floats(-1.0, 1.0)), st.integers(1, 8))
def test_second_differences_are_undone_by_two_sums(channels, cut):
    values, scale = second_differences(channels, np.array([0, cut, 9]), 1)
    for begin, end in ((0, cut), (cut, 9)):
        own = values[5 * begin : 5 * end].reshape(5, -1)
        found = np.cumsum(np.cumsum(own, axis=1), axis=1).T * scale
        assert found == pytest.approx(channels[begin:end], abs=0.51 * scale.max() + 1e-6)


def test_long_jumps_take_longer_steps():
    values, scale = second_differences(np.array([[0.0], [900.0]]), np.array([0, 2]), 0)
    assert np.abs(values).max() <= 32_767 and np.cumsum(np.cumsum(values))[1] * scale[0] == pytest.approx(900, rel=1e-3)


def test_splines_meet_the_frames_of_each_performance_and_ends_are_held():
    frames = np.random.default_rng(0).normal(size=(12, 2))
    first = np.array([0, 6, 7, 9, 12])
    control = control_points(frames, first)
    for begin, end in pairwise(first.tolist()):
        own = control[begin:end]
        assert between(own, np.arange(float(end - begin))) == pytest.approx(frames[begin:end])
        assert between(own, np.array([-1.0, 99.0])) == pytest.approx(frames[[begin, end - 1]])


def test_a_swing_is_met_far_better_than_by_straight_lines():
    at = np.arange(0.0, 12.01, 0.4)
    frames, asked = np.sin(at)[:, None], np.linspace(3, 27, 500)
    assert between(control_points(frames, np.array([0, at.size])), asked)[:, 0] == pytest.approx(
        np.sin(0.4 * asked), abs=2e-4
    )


def test_whole_numbers_are_folded_small_ones_first():
    assert folded(np.array([0, -1, 1, -2, 2])).tolist() == [0, 1, 2, 3, 4]
    assert folded(np.array([-32_767, 32_767])).max() == 65_534


def test_rate_and_components_are_tried_on_people_all_over_the_run():
    """Blocks are many people of a workforce, and of one block two performances told too little: 5 mm at a hand."""
    model = load_library(shipped_folder() / "libraries" / "bench_work.npz")["stoop"]
    some = model.sample(60, np.random.default_rng(0))
    one, two = (Drawn("stoop", some.skeleton, blocks, first) for blocks, first in (
        ((some,), (0, 60)), ((some[:1], some[1:]), (0, 1, 60)),
    ))  # fmt: skip
    assert chosen(one) == chosen(two)


def test_bodies_of_another_emulator_are_packed_by_their_joints_alone():
    block = Nodding(4)
    some = rows_of(block, np.array([1, 3]))
    drawn = Drawn("nod", some.skeleton, (some,), (0, 2))
    columns = Columns()
    told = pack_frames(drawn, 0, columns, "m0_")
    found = unpacked_columns(columns.table, columns.close())
    assert told["codec"] == "frames" and told["n"] == 2
    assert found["m0_duration_s"] == pytest.approx(block.duration_s[[1, 3]], rel=1e-6)
    assert found["m0_bone_m"] == pytest.approx([0.5, 0.2, 0.5, 0.2])
    frames = frames_of(drawn, 20.0)
    joints = block.positions_m(times_s=np.full((4, 1), 0.5))[1, 0]
    assert frames.path[10, :3] == pytest.approx(joints[0]) and frames.directions[10, 3:] == pytest.approx(
        (joints[2] - joints[1]) / 0.2
    )


META = {"name": "base", "title": "A cell", "notes": [["Walking", "made up"]], "columns": {}}
HOSTILE = "</script><script>window.harmed = 1</script>"


def written(tmp_path, parts, title="A cell", notes=()):
    path = tmp_path / "replay.html"
    size = write_replay(parts, path, title, notes)
    text = path.read_text(encoding="utf-8")
    assert size == path.stat().st_size
    return text


def column_bytes(text, number):
    block = re.search(rf'<script type="text/plain" id="columns-{number}">([^<]*)</script>', text).group(1)
    return gzip.decompress(base64.b64decode(block))


def test_the_columns_come_back_as_they_were(tmp_path):
    rng = np.random.default_rng(0)
    parts = [(META, rng.bytes(size)) for size in (0, 8, 3_000_008)]  # noise: gzip does not make it smaller
    text = written(tmp_path, parts)
    assert [column_bytes(text, number) for number in range(3)] == [columns for _, columns in parts]


def test_the_same_parts_give_the_same_bytes(tmp_path):
    assert written(tmp_path, [(META, bytes(80))]) == written(tmp_path, [(META, bytes(80))])


def test_names_are_escaped_wherever_they_stand(tmp_path):
    meta = {**META, "name": HOSTILE, "notes": [[HOSTILE, HOSTILE]]}
    text = written(tmp_path, [(meta, b"")], HOSTILE, [(HOSTILE, HOSTILE)])
    assert HOSTILE not in text
    told = json.loads(re.search(r'id="replay">(.*?)</script>', text).group(1))
    assert told["title"] == told["variants"][0]["name"] == HOSTILE


def test_a_note_that_variants_share_stands_once(tmp_path):
    text = written(tmp_path, [(META, b""), (META, b"")], notes=[("From", "a test")])
    assert text.count("<dt>Walking</dt><dd>made up</dd>") == 1 and "<dt>From</dt><dd>a test</dd>" in text


def test_only_the_page_s_own_script_may_run(tmp_path):
    text = written(tmp_path, [(META, b"")])
    allowed = policy(page_script()).replace("'", "&#39;")
    assert f'content="{allowed}"' in text and page_script() in text
    assert "eval(" not in page_script() and "new Function" not in page_script() and "</script" not in page_script()


def test_a_replay_of_nothing_is_refused(tmp_path):
    with pytest.raises(ValueError, match="a variant at least"):
        write_replay([], tmp_path / "replay.html", "nothing")
