"""The encoder is a stand-in that counts what it is given: whether a real one is at hand is another machine's matter."""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from opsim.report.plot.animation import HOLD_S, Video
from opsim.report.plot.body import COLOURS
from opsim.report.plot.video import MOST_BYTES, Film, _share, missing_encoder, posture, video_html, write_video
from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from opsim.report.sections.motions import Card
from tests.made.cards import SKELETON, cards, video


def film_of(page):
    return json.loads(re.search(r'id="film">(.*?)</script>', page, re.DOTALL).group(1))


def test_the_mean_comes_first_then_the_simulated_ones_in_order():
    labels = re.findall(r"<figcaption><b>(.*?)</b>", video_html(video(3)))
    assert labels == ["mean performance", "simulated 1", "simulated 2", "simulated 3"]


def test_who_it_is_stands_below_each_label():
    assert re.findall(r'small">(.*?)</span></figcaption>', video_html(video(1))) == ["person 0", "person 1"]


def test_there_is_no_guessing_on_the_page():
    page = video_html(video(2))
    assert "data-guess" not in page and "answers" not in film_of(page) and 'id="reveal"' not in page


def test_only_the_mean_is_framed():
    assert video_html(video(3)).count('class="card first"') == 1


def test_the_same_video_gives_the_same_page(tmp_path):
    first, again = (write_video(video(2), tmp_path / f"{i}.html") for i in (0, 1))
    assert first.read_bytes() == again.read_bytes()


def test_another_ending_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"found the ending '\.avi', expected \.html or \.gif or \.mp4"):
        write_video(video(1), tmp_path / "x.avi")


@pytest.mark.parametrize("ending", [".html", ".GIF"])
def test_the_ending_decides_whatever_its_case(tmp_path, ending):
    begins = {".html": b"<!doctype html>", ".GIF": b"GIF89a"}[ending]
    assert write_video(video(0, seconds=0.1), tmp_path / f"x{ending}").read_bytes().startswith(begins)


def test_names_cannot_break_out_of_the_page():
    evil = "</script><script>window.harmed = 1</script>"
    mean = Card(cards(1)[0].positions_m, False, evil)
    page = video_html(Video(evil, evil, mean, (), SKELETON, ((evil, evil),)))
    assert "<script>window" not in page and page.count("</script>") == 2


def heard(*_):
    """Progress that nobody reads."""


def test_frames_stand_evenly_in_time_and_the_last_at_the_end_of_the_longest():
    film = Film(video(2, seconds=0.5), 20.0)
    assert film.longest_s == pytest.approx(0.7)
    assert film.times_s == pytest.approx(np.arange(15) / 20.0)
    odd = Film(video(0, seconds=16 / 30), 20.0)
    assert odd.times_s[-1] == pytest.approx(16 / 30) and len(odd.times_s) == 12


def test_a_posture_lies_between_its_frames_and_stays_at_the_end():
    card = video(0).mean
    assert np.allclose(posture(card, 3.5 / RATE_HZ), card.positions_m[3:5].mean(axis=0))
    assert np.allclose(posture(card, 99.0), card.positions_m[-1])


def test_the_body_that_has_ended_stands_still_while_the_longer_one_goes_on():
    film = Film(video(1, seconds=0.3), 20.0, narrower=0.5)
    a, b = (np.asarray(film.frame(at_s)) for at_s in (0.32, 0.38))
    wide, high = film.body_px
    moved = [np.any(a[y : y + high, x : x + wide] != b[y : y + high, x : x + wide]) for x, y in film.sheet.places]
    assert moved == [False, True]


def test_the_clock_runs():
    film = Film(video(0), 20.0, narrower=0.5)
    x, y = film.sheet.clock
    clocks = {np.asarray(film.frame(at_s))[y : y + 20, x - 80 : x].tobytes() for at_s in (0.1, 0.15, 0.2)}
    assert len(clocks) == 3


def test_all_frames_have_one_size_and_progress_is_told():
    film, told = Film(video(1), 10.0, narrower=0.5), []
    sizes = {frame.size for frame in film.frames(lambda *words: told.append(words))}
    assert len(sizes) == 1 and told[0] == (0, 7) and told[-1] == (7, 7)


@pytest.fixture(scope="module")
def gif(tmp_path_factory):
    """A GIF of a mean and two simulated ones, the longest of 0.7 s."""
    return write_video(video(2), tmp_path_factory.mktemp("gif") / "x.gif")


def frames(path):
    """(milliseconds, picture) of each."""
    with Image.open(path) as opened:
        for k in range(opened.n_frames):
            opened.seek(k)
            yield opened.info["duration"], np.asarray(opened.convert("RGB"))


def test_it_runs_in_real_time_and_for_ever(gif):
    durations_ms = [ms for ms, _ in frames(gif)]
    assert sum(durations_ms[:-1]) == pytest.approx(700, abs=50) and set(durations_ms[:-1]) == {50}
    assert durations_ms[-1] == 1000 * HOLD_S
    with Image.open(gif) as opened:
        assert opened.info["loop"] == 0


def test_its_colours_are_those_that_were_drawn(gif):
    _, picture = next(frames(gif))
    seen = {tuple(colour) for colour in picture.reshape(-1, 3)}
    assert tuple(picture[1, 1]) == (255, 255, 255)
    assert {tuple(int(c[i : i + 2], 16) for i in (1, 3, 5)) for c in COLOURS} <= seen


def test_every_third_frame_looks_like_the_picture_it_was_made_of(gif):
    film = Film(video(2), 20.0)
    for (_, shown), at_s in list(zip(frames(gif), film.times_s))[::3]:
        apart = np.abs(shown.astype(int) - np.asarray(film.frame(float(at_s))).astype(int)).max(axis=-1)
        assert apart.mean() < 0.5 and np.mean(apart > 40) < 1e-3


def test_the_same_video_gives_the_same_bytes(tmp_path):
    first, again = (write_video(video(0, seconds=0.1), tmp_path / f"{i}.gif") for i in (0, 1))
    assert first.read_bytes() == again.read_bytes()


def test_it_says_where_it_comes_from_in_its_comment(gif):
    with Image.open(gif) as opened:
        assert opened.info["comment"] == b"reach: The mean beside 2."


def test_a_long_film_is_drawn_smaller_and_a_short_one_in_full():
    assert _share(Film(video(2), 20.0)) == 1.0
    long = Film(video(8, seconds=12.0), 20.0)
    assert 0.5 <= _share(long) < 1.0


def test_half_a_second_of_three_bodies_stays_far_below_the_limit(gif):
    assert gif.stat().st_size < MOST_BYTES / 10


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
