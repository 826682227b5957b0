"""``opsim motion fit --cyclic``: from recorded walks to walking of any length, drawn and shown."""

import pytest

from emulator.model.library import MotionLibrary
from emulator.recordings.npz import write_recording
from emulator.synthetic.walking import make_walks
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

WALKING = shipped_folder() / "libraries" / "walking.npz"


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    path = tmp_path_factory.mktemp("walks") / "stroll.npz"
    write_recording(make_walks(2, 3, seed=1)[0], path)
    return path


def test_walks_become_a_library_that_says_how_they_walk(recorded, tmp_path):
    code, out, _ = opsim("motion", "fit", recorded, "--cyclic", "-o", tmp_path / "lib.npz")
    assert code == 0
    assert "foot skate" in out and "stride time" in out
    model = MotionLibrary.load(tmp_path / "lib.npz")["stroll"]
    assert model.report.command == "opsim motion fit stroll.npz -o lib.npz --cyclic"


def test_takes_are_chosen_by_where(recorded, tmp_path):
    code, _, _ = opsim("motion", "fit", recorded, "--cyclic", "--where", "worker == w1", "-o", tmp_path / "one.npz")
    assert code == 0
    assert MotionLibrary.load(tmp_path / "one.npz")["stroll"].workers == ("w1",)


def test_settings_of_repetitions_are_refused_with_it(recorded, tmp_path):
    code, _, err = opsim(
        "motion", "fit", recorded, "--cyclic", "--landmarks", "0.1", "--where", "nobody == 1", "-o", tmp_path / "no.npz"
    )
    assert code == 2
    assert "--landmarks" in err and "nobody" in err
    assert not (tmp_path / "no.npz").exists()


def test_walks_are_shown_over_their_footprints(tmp_path):
    code, out, _ = opsim("motion", "show", WALKING, "walk", "-n", 1, "-o", tmp_path / "walk.svg")
    assert code == 0 and "made" in out
    svg = (tmp_path / "walk.svg").read_text()
    assert svg.count("<path") > 100


def test_walks_are_sampled_like_any_task(tmp_path):
    code, out, _ = opsim("motion", "sample", WALKING, "-n", 2, "-o", tmp_path / "walks.npz")
    assert code == 0 and "duration" in out
    assert (tmp_path / "walks.npz").exists()
