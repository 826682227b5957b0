"""``opsim motion segment``: pieces, cut times and picture; what a person corrects is never overwritten."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings.npz import read_recording, write_recording
from emulator.recordings.take import Recording
from tests.emulator.segmenting.made_movements import walking
from tests.emulator.segmenting.test_repetitions import made_take
from tests.opsim.cli.calls import opsim


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """reaches.npz: one take of five made reaches; walks.npz: two takes of swinging."""
    folder = tmp_path_factory.mktemp("takes")
    write_recording(Recording((made_take("reach", 5, seed=2)[0],), "made", "MIT"), folder / "reaches.npz")
    walks = (walking(worker="ana"), walking(4.5, worker="ben"))
    write_recording(Recording(walks, "made", "MIT"), folder / "walks.npz")
    return folder


@pytest.fixture(scope="module")
def cut_once(folder, tmp_path_factory):
    """A folder with the reaches cut, which no test changes."""
    out = tmp_path_factory.mktemp("cut") / "cut.npz"
    code, shown, _ = opsim("motion", "segment", folder / "reaches.npz", "-o", out)
    assert code == 0 and "5 pieces of 1 take" in shown
    return out.parent


@pytest.fixture
def cut(cut_once, tmp_path):
    """The same in a folder of its own."""
    return shutil.copytree(cut_once, tmp_path / "cut") / "cut.npz"


def test_each_repetition_is_a_take_of_the_same_worker_with_numbered_trial(cut, folder):
    takes, source = read_recording(cut).takes, read_recording(folder / "reaches.npz").takes[0]
    assert [take.name for take in takes] == [f"{source.name}.{n}" for n in range(1, 6)]
    assert "cut from reaches.npz: 5 pieces of 1 takes" in read_recording(cut).notes
    assert read_recording(cut).licence == "MIT"


def test_beside_the_pieces_are_cut_times_and_a_picture(cut):
    assert cut.with_suffix(".cuts.txt").read_text().count("\n") == 8
    assert cut.with_suffix(".segment.svg").read_text().startswith("<?xml")


def test_cut_times_given_back_unchanged_give_the_same_pieces(cut, folder, tmp_path):
    again = tmp_path / "again.npz"
    times = cut.with_suffix(".cuts.txt")
    assert opsim("motion", "segment", folder / "reaches.npz", "--cuts", times, "-o", again)[0] == 0
    for one, other in zip(read_recording(cut).takes, read_recording(again).takes, strict=True):
        assert np.array_equal(one.positions_m, other.positions_m) and one.name == other.name
    assert not again.with_suffix(".cuts.txt").exists()


def test_corrected_cut_times_are_used_and_never_overwritten(cut, folder):
    times = cut.with_suffix(".cuts.txt")
    lines = times.read_text().split("\n")
    edited = "\n".join([*lines[:2], "1.0 2.0 up", *lines[4:6]]) + "\n"
    times.write_text(edited)
    code, _, said = opsim("motion", "segment", folder / "reaches.npz", "-o", cut)
    assert code == 2 and f"found cut times that were edited, expected --cuts {times}" in said
    assert opsim("motion", "segment", folder / "reaches.npz", "-o", cut, "--cuts", times)[0] == 0
    assert [take.trial for take in read_recording(cut).takes] == ["long.up", "long.3", "long.4"]
    assert times.read_text() == edited


def test_cycles_of_several_takes_are_counted_by_take_with_units_and_dimension(folder, tmp_path):
    code, shown, _ = opsim("motion", "segment", folder / "walks.npz", "-o", tmp_path / "w.npz", "--json")
    found = json.loads(shown)
    assert code == 0 and [row["take"] for row in found["takes"]] == ["ana/1", "ben/1"]
    assert all(row["kind"] == "cycles" and row["pieces"] >= 3 for row in found["takes"])
    assert all(sum(row["units"].values()) == row["frames"] and row["dimension"] >= 1 for row in found["takes"])
    assert set(found["files"]) == {"recording", "cut_times", "picture"}
    assert len(read_recording(tmp_path / "w.npz").takes) == sum(row["pieces"] for row in found["takes"])


def test_a_take_in_which_nothing_is_found_takes_nothing_from_the_others(folder, tmp_path):
    takes = (walking(worker="ana"), walking(0.7, 100.0, worker="ben"))
    write_recording(Recording(takes), tmp_path / "two.npz")
    code, shown, said = opsim("motion", "segment", tmp_path / "two.npz", "--cycles", "-o", tmp_path / "w.npz")
    assert code == 0 and "of 1 take" in shown and "take ben/1: no cycles found" in said


def test_where_nothing_is_found_at_all_nothing_is_written(tmp_path):
    write_recording(Recording((walking(0.7, 100.0),)), tmp_path / "short.npz")
    code, _, said = opsim("motion", "segment", tmp_path / "short.npz", "--cycles", "-o", tmp_path / "new" / "w.npz")
    assert code == 2 and "cut times can be given with --cuts" in said
    assert not (tmp_path / "new").exists()


def test_every_mistake_is_said_at_once(folder, tmp_path):
    take = walking()
    gap = take.positions_m.copy()
    gap[9, 2] = np.nan
    takes = (replace(take, positions_m=gap), replace(walking(worker="w2"), positions_m=take.positions_m[:5]))
    write_recording(Recording(takes), tmp_path / "bad.npz")
    code, _, said = opsim("motion", "segment", tmp_path / "bad.npz", "-o", tmp_path / "out.csv")
    assert code == 2
    for words in (
        "out.csv: found the ending '.csv'",
        "take w1/1: found 1 gaps",
        "clean it first",
        "take w2/1: found 5 f",
    ):
        assert words in said


def test_the_recording_that_is_read_is_not_written_over(folder):
    before = (folder / "walks.npz").read_bytes()
    code, _, said = opsim("motion", "segment", folder / "walks.npz", "-o", folder / "walks.npz")
    assert code == 2 and "found the recording that is read" in said
    assert (folder / "walks.npz").read_bytes() == before


def test_mistakes_in_cut_times_are_said_with_their_lines(folder, tmp_path):
    (tmp_path / "times.txt").write_text("[ana/1]\n1 2 a\n1.5 3 b\n[bne/1]\n")
    words = ("motion", "segment", folder / "walks.npz", "--cuts", tmp_path / "times.txt", "-o", tmp_path / "w.npz")
    code, _, said = opsim(*words)
    assert code == 2 and "times.txt:3: found the start 1.500 s" in said and "times.txt:4: no take 'bne/1'" in said
    (tmp_path / "times.txt").write_bytes(b"\xff\xfe1 2 a")
    assert "no UTF-8 text" in opsim(*words)[2]
    assert "found together with --cuts" in opsim(*words, "--cycles")[2]


def test_more_neighbours_than_frames_are_refused(folder, tmp_path):
    code, _, said = opsim("motion", "segment", folder / "walks.npz", "--k", 5000, "-o", tmp_path / "w.npz")
    assert code == 2 and "found k = 5000 neighbours" in said


def test_repetitions_without_a_rest_between_them_are_doubted(folder, tmp_path):
    words = ("motion", "segment", folder / "walks.npz", "--repetitions", "-o", tmp_path / "w.npz")
    code, _, said = opsim(*words)
    assert code == 0 and "take ana/1: no rest found at 5 of the 5 places" in said and "--cycles is meant for" in said
    code, shown, said = opsim("motion", "segment", folder / "reaches.npz", "-o", tmp_path / "r.npz", "--repetitions")
    assert code == 0 and "no rest" not in said and "dimension: how many numbers" in shown


def test_a_folder_is_no_file_of_cut_times(folder, tmp_path):
    code, _, said = opsim("motion", "segment", folder / "walks.npz", "--cuts", tmp_path, "-o", tmp_path / "w.npz")
    assert code == 2 and f"{tmp_path}: found a folder, expected a file of cut times" in said


def test_the_picture_and_the_terminal_say_how_many_takes_are_shown(tmp_path):
    takes = tuple(walking(2.5, worker=f"w{number}") for number in range(5))
    write_recording(Recording(takes), tmp_path / "five.npz")
    code, _, said = opsim("motion", "segment", tmp_path / "five.npz", "-o", tmp_path / "w.npz")
    assert code == 0 and "the picture shows the first 4 of 5 takes" in said
    assert "the first 4 of 5 takes" in (tmp_path / "w.segment.svg").read_text(encoding="utf-8")


def test_control_c_while_drawing_says_what_was_written(folder, tmp_path, monkeypatch):
    def stops(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("opsim.report.motion.segmentation.draw_cuts", stops)
    out = tmp_path / "w.npz"
    code, _, said = opsim("motion", "segment", folder / "walks.npz", "-o", out)
    there = f"{out}, {out.with_suffix('.cuts.txt')}"
    assert code == 130 and f"stopped; written: {there}; not written: {out.with_suffix('.segment.svg')}" in said
