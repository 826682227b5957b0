import numpy as np
import pytest

from opsim.report.plot.video import Film, posture
from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from tests.made_cards import video


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
