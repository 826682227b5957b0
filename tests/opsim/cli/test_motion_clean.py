"""``opsim motion clean``: what is written, shown and refused."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

from emulator.cleaning import Repair
from emulator.recordings.npz import read_recording, write_recording
from opsim.cli.motion.clean_page import column_of
from tests.made.takes import clean, error_m, same, spoilt
from tests.opsim.cli.calls import opsim


def faults(positions, index):
    positions[40:43, index("right_wrist")] += [0.0, 0.25, 0.2]
    positions[20:26, index("left_elbow")] = np.nan


@pytest.fixture
def spoiled(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_recording(spoilt(clean(), faults), tmp_path / "reach.npz")
    return tmp_path


def test_the_cleaned_recording_is_written_with_a_table_and_pictures(spoiled):
    code, said, _ = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", "--repairs", "found.csv")
    assert code == 0
    written = read_recording("clean.npz")
    assert error_m(written.takes[1], clean().takes[1]) < 0.01
    assert same(replace(written, takes=written.takes[:1]), replace(clean(), takes=clean().takes[:1]))
    assert any(note.startswith("cleaned: ") for note in written.notes)
    assert "8 takes: 7 good, 1 repaired" in said and "w1/r2" in said
    rows = list(csv.DictReader((spoiled / "found.csv").read_text(encoding="utf-8").splitlines()))
    assert {(row["kind"], row["joints"], row["first_frame"]) for row in rows} == {
        ("glitch", "right_wrist", "40"),
        ("gap", "left_elbow", "20"),
    }
    assert {row["verdict"] for row in rows} == {"repaired"}
    page = (spoiled / "clean.clean.html").read_text(encoding="utf-8")
    assert "default-src 'none'" in page and "right_wrist: jumps" in page and "<svg" in page
    assert (spoiled / "clean.clean.svg").read_text(encoding="utf-8").startswith("<?xml")


@pytest.mark.slow
def test_the_same_call_gives_the_same_bytes(spoiled):
    for name in "ab":
        assert opsim("motion", "clean", "reach.npz", "-o", f"{name}.npz")[0] == 0
    for ending in (".npz", ".clean.svg", ".clean.html"):
        assert (spoiled / f"a{ending}").read_bytes() == (spoiled / f"b{ending}").read_bytes()


def test_json_says_everything_for_machines(spoiled):
    code, said, _ = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", "--no-pictures", "--json")
    found = json.loads(said)
    assert code == 0 and found["pictures"] == [] and not (spoiled / "clean.clean.svg").exists()
    assert found["takes"][1] == {"take": "w1/r2", "verdict": "repaired", "found": {"glitch": 1, "gap": 1}}
    assert {repair["kind"] for repair in found["repairs"]} == {"glitch", "gap"}
    assert found["moved_mm"]["w1/r1"] == 0.0 < found["moved_mm"]["w1/r2"]


def test_strict_lists_every_fault_and_writes_nothing(spoiled):
    code, _, said = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", "--strict")
    lines = [line for line in said.splitlines() if not line.startswith("clean reach")]
    assert code == 2 and lines[0] == "reach.npz: --strict: found 2 faults in 1 of 8 takes, expected none"
    assert "w1/r2: frames 40 to 42: right_wrist: jumps, as no body can, and comes back" in lines[1]
    assert "bridged" not in said and not list(spoiled.glob("clean*"))


def test_strict_passes_a_clean_recording(tmp_path):
    write_recording(clean(), tmp_path / "reach.npz")
    code, said, _ = opsim("motion", "clean", tmp_path / "reach.npz", "-o", tmp_path / "clean.npz", "--strict")
    assert code == 0 and "8 takes: 8 good" in said
    assert same(read_recording(tmp_path / "clean.npz"), clean())


def test_bad_takes_are_left_out_where_asked_and_said(spoiled):
    words = ("--set", "jumps=tell", "--drop-bad", "--no-pictures")
    assert opsim("motion", "clean", "reach.npz", "-o", "clean.npz", *words)[0] == 0
    written = read_recording("clean.npz")
    assert len(written.takes) == 7 and "w1/r2" not in {take.name for take in written.takes}
    assert "left out for faults that stay: w1/r2" in written.notes


def test_settings_are_taken(spoiled):
    words = ("--set", "bones=mend", "--set", "gaps=cut", "--no-pictures", "--json")
    found = json.loads(opsim("motion", "clean", "reach.npz", "-o", "clean.npz", *words)[1])
    assert "cut" in {repair["kind"] for repair in found["repairs"]}
    assert "gap" not in {repair["kind"] for repair in found["repairs"]}


def test_every_mistake_of_a_call_is_said_at_once(spoiled):
    words = ("--set", "jump=off", "--set", "noise", "--set", "bones=rigid", "--repairs", "found.txt")
    code, _, said = opsim("motion", "clean", "reach.npz", "-o", "reach.npz", *words)
    assert code == 2
    for expected in (
        "reach.npz: found the recording that is read, expected another file to write",
        "found.txt: found the ending '.txt', expected .csv",
        "--set: found 'noise', expected NAME=VALUE",
        "--set: no setting 'jump'; did you mean 'jumps'?",
        "--set: bones: found 'rigid', expected tell or mend or off",
    ):
        assert expected in said
    assert same(read_recording("reach.npz"), spoilt(clean(), faults)) and not list(spoiled.glob("*.html"))


@pytest.mark.parametrize(
    ("out", "said"),
    [("clean.csv", "found the ending '.csv', expected .npz"), ("lib.npz", "found a library, expected a new file")],
)
def test_what_cannot_be_the_output_is_refused(spoiled, out, said):
    import shutil

    from opsim.shipped import shipped_folder

    shutil.copy(shipped_folder() / "libraries" / "bench_work.npz", spoiled / "lib.npz")
    code, _, complaint = opsim("motion", "clean", "reach.npz", "-o", out)
    assert code == 2 and said in complaint


def test_a_recording_in_centimetres_is_refused_with_its_unit(tmp_path):
    takes = tuple(replace(take, positions_m=100 * take.positions_m) for take in clean().takes)
    write_recording(replace(clean(), takes=takes), tmp_path / "reach.npz")
    code, _, said = opsim("motion", "clean", tmp_path / "reach.npz", "-o", tmp_path / "new" / "clean.npz")
    assert code == 2 and "in centimetres it would be 1.5" in said and "reach.npz: take w1/r1" in said
    assert not (tmp_path / "new").exists()


def test_a_file_that_is_no_recording_is_refused(tmp_path):
    code, _, said = opsim("motion", "clean", tmp_path / "none.npz", "-o", tmp_path / "clean.npz")
    assert code == 2 and "no such file" in said


@pytest.fixture
def gone(tmp_path, monkeypatch):
    """Eight takes; of one frames 10 to 29 are not seen."""

    def change(positions, index):
        positions[10:30] = np.nan

    monkeypatch.chdir(tmp_path)
    takes = tuple(replace(take, mark_frame={}) for take in spoilt(clean(), change).takes)
    write_recording(replace(clean(), takes=takes), tmp_path / "reach.npz")
    return tmp_path


def test_a_take_that_lost_a_part_of_its_movement_is_shortened_not_repaired(gone):
    code, said, _ = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", "--repairs", "found.csv")
    assert code == 0 and "8 takes: 7 good, 1 shortened (by up to 0.60 s)" in said
    assert "0.60 s cut off 1 take" in said and "repaired" not in said
    assert "1 shortened (by up to 0.60 s)" in (gone / "clean.clean.html").read_text(encoding="utf-8")
    rows = list(csv.DictReader((gone / "found.csv").read_text(encoding="utf-8").splitlines()))
    assert [(row["verdict"], row["shortens"]) for row in rows] == [("shortened", "True")]


def test_shortened_takes_are_dropped_with_the_bad_ones_and_said(gone):
    code, said, _ = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", "--drop-bad", "--no-pictures")
    assert code == 0 and len(read_recording("clean.npz").takes) == 7
    assert "left out for frames of the movement that are gone: w1/r2" in said


def test_what_was_mended_and_what_was_left_stand_apart_with_one_unit_each():
    jump = Repair("w/1", "glitch", ("head",), 3, 4, 0.1, "m", "jumps; bridged")
    step = replace(jump, size=17.0, unit="m/s", mended=False, bad=True)
    columns = [column_of(each) for each in (jump, step, replace(jump, mended=False), replace(jump, kind="hold"))]
    assert columns == ["glitch", "glitch left", "glitch left by", "hold"]


def test_a_cut_off_beyond_half_the_frame_rate_is_refused_beside_other_mistakes(spoiled):
    words = ("--set", "cut_off_hz=500", "--set", "bones=rigid")
    code, _, said = opsim("motion", "clean", "reach.npz", "-o", "clean.npz", *words)
    assert code == 2 and "--set: bones: found 'rigid'" in said and not list(spoiled.glob("clean*"))
    assert "--set: cut_off_hz: found 500, expected less than 25, half of the recording's 50 frames a second" in said


def stops(*_, **__):
    raise KeyboardInterrupt


def test_control_c_while_writing_leaves_nothing_half_written(spoiled, monkeypatch):
    monkeypatch.setattr("emulator.recordings.npz.np.lib.format.write_array", stops)
    code, _, said = opsim("motion", "clean", "reach.npz", "-o", "clean.npz")
    assert code == 130 and "stopped; nothing was written" in said
    assert [path.name for path in spoiled.iterdir()] == ["reach.npz"]


def test_control_c_while_drawing_says_what_was_written(spoiled, monkeypatch):
    monkeypatch.setattr("opsim.report.motion.cleaning_charts.write_cleaned", stops)
    code, _, said = opsim("motion", "clean", "reach.npz", "-o", "clean.npz")
    assert code == 130 and read_recording("clean.npz").takes
    assert "stopped; written: clean.npz; not written: clean.clean.svg, clean.clean.html" in said
