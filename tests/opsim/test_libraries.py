import os

import pytest

from opsim.libraries import LibraryMissing, library_people, library_tasks, load_library, resolve_library
from opsim.shipped import shipped_folder
from tests.opsim.made_walks import made_library


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


def test_the_tasks_come_from_the_header_of_the_file_as_it_is_now(tmp_path, monkeypatch):
    headers = {b"one": {"tasks": {"lift": {}}}, b"two": {"tasks": {"lift": {}, "carry": {}}}, b"other": {}}
    monkeypatch.setattr("emulator.model.library.read_header", lambda path: headers[path.read_bytes()])
    file = tmp_path / "moves.npz"
    file.write_bytes(b"one")
    assert library_tasks(file) == ["lift"]
    file.write_bytes(b"two")
    os.utime(file, ns=(1, 1))
    assert library_tasks(file) == ["lift", "carry"]
    file.write_bytes(b"other")
    with pytest.raises(LibraryMissing, match="without a list of tasks"):
        library_tasks(file)


def test_a_file_that_is_no_library_is_said_to_be_none(tmp_path):
    (tmp_path / "moves.npz").write_bytes(b"not a library")
    with pytest.raises(LibraryMissing, match=r"^moves\.npz: not a motion library"):
        library_tasks(tmp_path / "moves.npz")


def test_the_people_of_a_library_stand_in_its_header():
    people = library_people(resolve_library("libraries/public_movements.npz", shipped_folder()))
    assert people["shoulder_scaption"] == ("s01", "s02", "s03", "s04", "s06")
    assert (
        people["deep_squat"] == load_library(shipped_folder() / "libraries/public_movements.npz")["deep_squat"].workers
    )


def test_a_task_whose_people_are_not_named_has_none(tmp_path, monkeypatch):
    header = {"tasks": {"lift": {}, "carry": {"workers": "ana"}, "turn": ["ana"], "walk": {"workers": ["ana", 7]}}}
    monkeypatch.setattr("emulator.model.library.read_header", lambda path: header)
    (tmp_path / "moves.npz").write_bytes(b"")
    assert library_people(tmp_path / "moves.npz") == {"lift": (), "carry": (), "turn": (), "walk": ("ana", "7")}


def test_a_library_says_how_fast_its_walkers_walk_and_of_other_tasks_nothing(tmp_path, monkeypatch):
    from opsim.libraries import library_speeds

    path = made_library(tmp_path, monkeypatch)
    assert library_speeds(path) == {"walk": (0.3, 2.5)}
    assert library_speeds(resolve_library("libraries/bench_work.npz", tmp_path)) == {}
    assert list(library_speeds(resolve_library("libraries/walking.npz", tmp_path))) == ["walk"]


@pytest.mark.parametrize(
    "said", [None, {}, {"kind": "cyclic"}, {"kind": "cyclic", "pace": 3}, {"pace": {"steps": True}}]
)
def test_tasks_that_do_not_walk_have_no_speeds(tmp_path, said):
    from emulator.archive import write_archive
    from opsim.libraries import library_speeds

    write_archive(tmp_path / "odd.npz", {"tasks": {"walk": said}}, {})
    assert library_speeds(tmp_path / "odd.npz") == {}
