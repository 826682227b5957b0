import gzip
import json

import numpy as np
import pytest
from made_scene import SHOWN, packed_scene, run_of, scene
from page_twin import Twin

from opsim.log import WORKER_KINDS
from opsim.viewer.build import scene_of
from opsim.viewer.pose import joints_m
from opsim.viewer.skeletons import unpacked_columns
from opsim.viewer.write import LEVEL, packed

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


def test_a_second_of_movement_takes_less_than_a_kilobyte():
    """Compressed as the page is: 800 bytes."""
    meta, data = packed_scene("repack_cell")
    columns = unpacked_columns(meta["columns"], data)
    moving_s = sum(columns[model["columns"]["duration_s"]].sum() for model in meta["models"])
    assert moving_s > 600 and len(gzip.compress(data, LEVEL)) < 1000 * moving_s


def test_the_same_run_gives_the_same_bytes():
    run, window_s = run_of("walking_cell"), (200.0, 320.0)
    (one, first), (other, second) = (packed(scene_of(run, window_s=window_s)) for _ in range(2))
    assert first == second and json.dumps(one) == json.dumps(other)


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
