"""No verb of ``opsim motion`` writes over what it reads, nor a library over a recording or the other way round."""

import shutil

import pytest

import emulator
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def made_reach(tmp_path_factory):
    path = tmp_path_factory.mktemp("made") / "reach.npz"
    assert opsim("motion", "sample", BENCH, "reach", "-n", 6, "--fps", 20, "-o", path)[0] == 0
    return path


@pytest.fixture
def folder(made_reach, tmp_path, monkeypatch):
    """A folder to stand in, with two recordings, a library under two names and a link to each kind."""
    for name in ("reach.npz", "other.npz"):
        shutil.copy(made_reach, tmp_path / name)
    for name in ("lib.npz", "lib.html"):
        shutil.copy(BENCH, tmp_path / name)
    (tmp_path / "link.npz").symlink_to("reach.npz")
    (tmp_path / "same.npz").symlink_to("lib.npz")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(emulator.MotionEmulator, "fit", lambda *_, **__: pytest.fail("the fit began"))
    return tmp_path


@pytest.mark.parametrize(
    "words, said",
    [
        ("fit reach.npz -o reach.npz", "reach.npz: found the recording that is read, expected another file to write"),
        ("fit reach.npz -o ../{}/reach.npz", "reach.npz: found the recording that is read"),
        ("fit reach.npz -o link.npz", "link.npz: found the recording that is read"),
        ("fit reach.npz -o other.npz", "other.npz: found a recording, expected a new file or a library to replace"),
        ("sample lib.npz reach -o lib.npz", "lib.npz: found the library that is read"),
        ("sample lib.npz reach -o same.npz", "same.npz: found the library that is read"),
        ("sample bench_work reach -o lib.npz", "lib.npz: found a library, expected a new file or a recording"),
        ("show lib.html reach --video -o lib.html", "lib.html: found the library that is read"),
        ("show lib.html reach --beside reach.npz -o lib.html", "lib.html: found the library that is read"),
        ("judge reach.npz -o reach.npz", "reach.npz: found a file"),
        ("judge reach.npz --paper -o reach.npz", "reach.npz: found a file"),
        ("people reach.npz -o reach.npz", "reach.npz: found a file"),
    ],
)
def test_what_is_read_is_never_written_over(folder, words, said):
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    code, _, complaint = opsim("motion", *words.format(folder.name).split())
    assert code == 2 and said in complaint
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_library_replaces_a_library_and_a_recording_a_recording(folder, monkeypatch):
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    assert opsim("motion", "fit", "reach.npz", "--n-components", 2, "-o", "lib.npz")[0] == 0
    assert (folder / "lib.npz").read_bytes() != BENCH.read_bytes()
    assert opsim("motion", "sample", "lib.npz", "reach", "-n", 2, "-o", "other.npz")[0] == 0
    assert (folder / "other.npz").read_bytes() != (folder / "reach.npz").read_bytes()
