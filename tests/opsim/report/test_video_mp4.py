"""The encoder is a stand-in that counts what it is given: whether a real one is at hand is another machine's matter."""

import sys
from pathlib import Path

import pytest

from opsim.report.plot.video import Film, missing_encoder, write_video
from tests.made_cards import video

COUNTS = "import sys; n = len(sys.stdin.buffer.read()); open(sys.argv[-1], 'w').write(f'{n} ' + ' '.join(sys.argv[1:]))"
FAILS = "import sys; sys.stdin.buffer.read(9); sys.stderr.write('first\\nUnknown encoder\\n'); sys.exit(3)"


@pytest.fixture
def encoder(tmp_path, monkeypatch):
    """Puts a program of this text first on the PATH as ffmpeg."""

    def put(text):
        folder = tmp_path / "bin"
        folder.mkdir()
        (folder / "ffmpeg.py").write_text(text)
        (folder / "ffmpeg").write_text(f'#!/bin/sh\nexec "{sys.executable}" "{folder / "ffmpeg.py"}" "$@"\n')
        (folder / "ffmpeg").chmod(0o755)
        monkeypatch.setenv("PATH", str(folder))

    return put


def test_the_encoder_gets_every_frame_and_the_last_one_for_as_long_as_the_page_waits(encoder, tmp_path):
    encoder(COUNTS)
    counted, *words = write_video(video(1), tmp_path / "x.mp4").read_text().split(" ")
    wide, high = Film(video(1), 30.0).sheet.picture.size
    assert int(counted) == wide * high * 3 * (19 + 24)
    assert f"{wide}x{high}" in words and words[words.index("-r") + 1] == "30" and "yuv420p" in words


def test_an_encoder_that_fails_is_quoted_and_leaves_no_file(encoder, tmp_path):
    encoder(FAILS)
    with pytest.raises(ValueError, match="ffmpeg ended with 3: Unknown encoder"):
        write_video(video(1), tmp_path / "x.mp4")
    assert [path.name for path in tmp_path.iterdir()] == ["bin"]


def test_without_an_encoder_one_is_told_what_to_install_and_what_works(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    said = missing_encoder(Path("x.mp4"))
    assert all(word in said for word in ("x.mp4: found no program ffmpeg", "apt-get install ffmpeg", ".html or .gif"))
    with pytest.raises(ValueError, match="found no program ffmpeg"):
        write_video(video(1), tmp_path / "x.mp4")
    assert missing_encoder(Path("x.gif")) == ""


def test_with_an_encoder_nothing_is_missing(encoder):
    encoder(COUNTS)
    assert missing_encoder(Path("x.MP4")) == ""
