import pytest

from opsim.libraries import LibraryMissing, library_tasks, resolve_library


def test_the_scenario_s_folder_comes_before_the_shipped_one(tmp_path, monkeypatch):
    shipped, own = tmp_path / "shipped", tmp_path / "own"
    for folder in (shipped, own):
        (folder / "libraries").mkdir(parents=True)
    monkeypatch.setattr("opsim.libraries.shipped_folder", lambda: shipped)
    (shipped / "libraries/moves.npz").write_bytes(b"")
    assert resolve_library("libraries/moves.npz", own) == shipped / "libraries/moves.npz"
    (own / "libraries/moves.npz").write_bytes(b"")
    assert resolve_library("libraries/moves.npz", own) == own / "libraries/moves.npz"


def test_a_missing_library_is_answered_with_the_nearest(tmp_path):
    (tmp_path / "moves.npz").write_bytes(b"")
    with pytest.raises(LibraryMissing, match=r"no library file 'mvoes.npz'; did you mean 'moves.npz'\?"):
        resolve_library("mvoes.npz", tmp_path)


def test_a_library_outside_the_folder_is_refused(tmp_path):
    with pytest.raises(LibraryMissing, match="must lie in the scenario's folder"):
        resolve_library("../../moves.npz", tmp_path)


def test_a_file_that_is_no_library_is_said_to_be_none(tmp_path):
    pytest.importorskip("emulator.library")
    (tmp_path / "moves.npz").write_bytes(b"not a library")
    with pytest.raises(LibraryMissing, match=r"'moves\.npz' is not a motion library"):
        library_tasks(tmp_path / "moves.npz")
