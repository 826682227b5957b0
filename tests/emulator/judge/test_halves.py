import numpy as np

from emulator.judge.held_out import in_halves, too_few
from emulator.model.emulator import MotionEmulator
from emulator.synthetic.tasks import make
from tests.emulator.judge.halved import halves, made


def names(motions):
    return {motion.name for motion in motions.motions}


def test_everybody_is_in_both_halves_and_no_repetition_is():
    half = halves()
    assert half.fitted.workers == half.held.workers == made().workers and half.task == "lift"
    assert names(half.fitted) | names(half.held) == names(made())
    assert not names(half.fitted) & names(half.held)
    assert half.a.shape == half.b.shape == (12, 31, made().skeleton.n_bones, 3)


def test_the_number_of_the_split_decides_who_is_where():
    assert names(in_halves(made(), 3, 31).fitted) == names(halves().fitted)
    assert names(in_halves(made(), 4, 31).fitted) != names(halves().fitted)


def test_the_fitted_half_is_aligned_as_an_emulator_aligns_it():
    """Else drawn and unseen postures would stand on two clocks."""
    emulator = MotionEmulator.fit(halves().fitted, n_times=31)
    centre = emulator.flatten.inverse(emulator.posture.mean.reshape(1, 31, -1))
    assert np.allclose(emulator.flatten.forward(halves().a).mean(axis=0).ravel(), emulator.posture.mean, atol=1e-3)
    assert centre.shape[1:] == halves().a.shape[1:]


def test_the_unseen_half_comes_closer_by_its_warps():
    """The spread about the fitted half's course, against that of the same repetitions in their own time."""
    from emulator.geometry.alignment import resample

    course = halves().a.mean(axis=0)
    plain = np.stack([resample(m.directions, np.linspace(0, 1, 31)) for m in halves().held.motions])
    aligned, unaligned = (np.mean((x - course) ** 2) for x in (halves().b, plain))
    assert aligned < 0.7 * unaligned


def test_people_with_one_repetition_hold_nothing_out():
    assert too_few(made()) == []
    (words,) = too_few(make("reach", 13, 1)[0])
    assert words == (
        "reach: 13 repetitions of 13 people hold out 0, one of two of each person; expected 5 or more to judge by"
    )
