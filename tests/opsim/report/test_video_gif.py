import numpy as np
import pytest
from PIL import Image

from opsim.report.plot.animation import HOLD_S
from opsim.report.plot.body import COLOURS
from opsim.report.plot.video import MOST_BYTES, Film, _share, write_video
from tests.made_cards import video


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


def test_every_frame_looks_like_the_picture_it_was_made_of(gif):
    film = Film(video(2), 20.0)
    for (_, shown), at_s in zip(frames(gif), film.times_s):
        apart = np.abs(shown.astype(int) - np.asarray(film.frame(float(at_s))).astype(int)).max(axis=-1)
        assert apart.mean() < 0.5 and np.mean(apart > 40) < 1e-3


def test_the_same_video_gives_the_same_bytes(gif, tmp_path):
    assert write_video(video(2), tmp_path / "again.gif").read_bytes() == gif.read_bytes()


def test_it_says_where_it_comes_from_in_its_comment(gif):
    with Image.open(gif) as opened:
        assert opened.info["comment"] == b"reach: The mean beside 2."


def test_a_long_film_is_drawn_smaller_and_a_short_one_in_full():
    assert _share(Film(video(2), 20.0)) == 1.0
    long = Film(video(8, seconds=12.0), 20.0)
    assert 0.5 <= _share(long) < 1.0


def test_half_a_second_of_three_bodies_stays_far_below_the_limit(gif):
    assert gif.stat().st_size < MOST_BYTES / 10
