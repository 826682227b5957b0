"""What is asked of ``opsim motion show`` and does not go together: every mistake at once, and nothing is written."""

import pytest

from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def complaint_on(*words):
    code, said, complaint = opsim("motion", "show", BENCH, "reach", *words)
    assert code == 2 and said == ""
    return complaint.strip()


@pytest.mark.parametrize(
    "words, said",
    [
        (["--video", "--beside", "x.npz"], "--video: found together with --beside, expected one of them"),
        (["--video", "--where", "all"], "--where: found without --beside, expected --beside RECORDING.npz"),
        (["--people", "new"], "--people: found without --video or --beside, expected one of them"),
        (["--person", "w1"], "--person: found without --video, expected --video"),
        (
            ["--video", "--people", "new", "--person", "w1"],
            "--person: found together with --people, expected one of them",
        ),
        (["--video", "-n", "0"], "-n: found 0, expected 1 to 20"),
        (["-n", "21"], "-n: found 21, expected 1 to 20"),
        (["--video", "-o", "x.avi"], "x.avi: found the ending '.avi', expected .html or .gif or .mp4 with --video"),
        (["--video", "-o", "x"], "x: found the ending '', expected .html or .gif or .mp4 with --video"),
        (["-o", "x.pdf"], "x.pdf: found the ending '.pdf', expected .png or .svg"),
        (["-o", "x.gif"], "x.gif: found the ending '.gif', expected .png or .svg, or --video: it is for what moves"),
        (["--video", "--person", "w1x"], "--person: reach: no worker 'w1x'; did you mean 'w1'?"),
    ],
)
def test_a_mistake_is_said_with_what_was_found_and_expected(folder, words, said):
    assert complaint_on(*words).splitlines() == [said]
    assert list(folder.iterdir()) == []


def test_all_mistakes_are_said_at_once(folder):
    words = ("--video", "-n", 99, "-o", "x.avi", "--where", "all")
    code, _, complaint = opsim("motion", "show", BENCH, "raech", *words)
    said = complaint.strip().splitlines()
    assert code == 2 and [line.partition(":")[0] for line in said[:3]] == ["--where", "-n", "x.avi"]
    assert len(said) == 4 and "did you mean 'reach'?" in said[3]


def test_a_folder_that_is_none_is_said_together_with_the_rest(folder):
    (folder / "file").write_text("")
    said = complaint_on("--video", "-n", 0, "-o", "file/x.gif").splitlines()
    assert said[0].startswith("-n: found 0") and "file/x.gif: cannot be written" in said[1]


def test_without_an_encoder_mp4_is_refused_before_anything_is_drawn(folder, monkeypatch):
    monkeypatch.setenv("PATH", str(folder))
    said = complaint_on("--video", "-o", "x.mp4")
    assert "found no program ffmpeg" in said and ".html or .gif" in said and list(folder.iterdir()) == []


def test_a_library_that_is_not_there_is_said_with_those_that_are(folder):
    code, _, complaint = opsim("motion", "show", "bench_wrok", "reach", "--video")
    assert code == 2 and "did you mean 'bench_work'?" in complaint


@pytest.mark.parametrize("words", [("-o", "x.png"), ("--video", "-o", "x.GIF")])
def test_without_matplotlib_it_is_said_before_anything_is_drawn(folder, monkeypatch, words):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    ending = words[-1][2:].upper()
    assert complaint_on(*words).startswith(f"{ending} files need matplotlib, which is not installed")
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("words", [("-n", 1, "-o", "x.svg"), ("--video", "-n", 1)])
def test_drawings_and_pages_need_no_matplotlib(folder, monkeypatch, words):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    assert opsim("motion", "show", BENCH, "reach", *words)[0] == 0
