import json

import numpy as np
import pytest
from made_scene import SHOWN, packed_scene, run_of, scene
from page_twin import Twin

from opsim.viewer.packed import packed
from opsim.viewer.posed import joints_m
from opsim.viewer.stage import scene_of


@pytest.mark.parametrize("name", SHOWN)
def test_the_page_shows_what_the_emulators_say(name):
    """From the packed columns alone, at random times of random people: within 2 mm at every joint, mostly far less."""
    shown, twin = scene(name), Twin(*packed_scene(name))
    rng, errors_m = np.random.default_rng(4), []
    for _ in range(200 if name != "kitting" else 40):
        worker, time_s = int(rng.integers(len(shown.workers))), float(rng.uniform(shown.low_s, shown.high_s))
        meant, found = joints_m(shown, worker, time_s), twin.joints_m(worker, time_s)
        assert (meant is None) == (found is None)
        if meant is not None:
            errors_m.append(np.linalg.norm(meant - found, axis=1).max())
    assert len(errors_m) > 30 and max(errors_m) < 2e-3 and np.mean(np.array(errors_m) < 1e-3) > 0.97


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
    assert {model["codec"] for model in meta["models"]} == {"scores", "frames"}
