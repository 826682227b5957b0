"""The law of all forward and inverse pairs, and what is particular to one."""

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.schemes import ISTVF, MTVF, SIEM, STVF
from emulator.schemes.scheme import FITTERS
from tests.emulator.fitted import recorded
from tests.emulator.schemes.cases import walks

FIELDS = ("IS-TVF", "S-TVF", "M-TVF")


@pytest.mark.parametrize("name", FITTERS)
def test_forward_and_inverse_are_a_pair(name):
    y = walks(6, 301, 20)
    there = FITTERS[name](y)
    flat, start = there.forward(y)
    assert flat.shape == ((6, 300, 40) if name in FIELDS else (6, 301, 40))
    assert start.shape == ((6, 40) if name in FIELDS else (6, 0))
    back = there.inverse(flat, start)
    assert np.abs(back - y).max() < 1e-12
    assert np.abs(np.linalg.norm(back, axis=-1) - 1).max() < 1e-13
    one_flat, one_start = there.forward(y[2])
    assert np.allclose(one_flat, flat[2], atol=1e-14) and np.allclose(one_start, start[2], atol=1e-14)
    assert np.allclose(there.inverse(one_flat, one_start), back[2], atol=1e-14)
    flat = 0.9 * flat
    assert np.abs(there.forward(there.inverse(flat, start))[0] - flat).max() < 1e-12


@pytest.mark.parametrize("task", ["deep_squat", "sit_to_stand"])
def test_is_tvf_and_siem_give_recordings_back_to_1e_12(task):
    y = align([m.directions for m in recorded(task).motions[:12]], n_times=301, max_iterations=2).directions
    for name in ("IS-TVF", "S-TVF", "SIEM", "SIEM-moving"):
        there = FITTERS[name](y)
        assert sphere.distance(there.inverse(*there.forward(y)), y).max() < 1e-12, name


def test_the_integral_of_a_field_on_one_sphere_is_the_angle_gone():
    """Known answer: along a great circle through the reference nothing turns, and all representations agree."""
    angle = np.linspace(-0.6, 0.6, 21)
    y = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)[None, :, None]
    integral, start = ISTVF.fit(y).forward(y)
    assert np.allclose(np.linalg.norm(integral[0], axis=-1), angle[1:] - angle[0], atol=1e-12)
    assert np.isclose(np.linalg.norm(start), 0.6, atol=1e-12)
    field, _ = STVF.fit(y).forward(y)
    assert np.allclose(field, np.diff(integral, axis=1, prepend=0.0))
    assert np.allclose(MTVF.fit(y).forward(y)[0], field, atol=1e-12)


def test_m_tvf_hops_through_every_earlier_posture():
    """The definition, hop for hop: from where a step starts back to alpha(0), and from there to the reference."""
    y = walks(2, 9, 3)
    there = MTVF.fit(y)
    field = there.forward(y)[0].reshape(2, 8, 3, 2)
    plane = sphere.basis(there.reference)
    for t in range(8):
        v = sphere.log(y[:, t], y[:, t + 1])
        for k in range(t, 0, -1):
            v = sphere.transport(y[:, k], y[:, k - 1], v)
        v = sphere.transport(y[:, 0], np.broadcast_to(there.reference, v.shape), v)
        assert np.allclose(np.einsum("nbc,bkc->nbk", v, plane), field[:, t], atol=1e-13)


def test_an_m_tvf_taken_back_by_one_hop_goes_wrong_along_time_and_hop_by_hop_it_does_not():
    """Figure 5 of the paper: what grows is the turning between two ways to the reference, not the rounding of hops."""
    y = walks(8, 301, 20)
    there = MTVF.fit(y)
    by_hops, by_one = there.inverse(*there.forward(y)), there.inverse_by_one_hop(*there.forward(y))
    error = sphere.distance(by_one, y).mean(axis=0)
    assert error[1] < 1e-12 and 1e-3 < error[30] < error[120] and error[-1] > 0.05
    assert sphere.distance(by_hops, y).max() < 1e-12


def test_noise_adds_up_along_a_field_and_not_under_siem():
    """A walk of 0.001 rad a step and coordinate: 20 bones are sqrt(pi / 2) 0.001 sqrt(t) each away; SIEM stays."""
    y, rng = walks(40, 301, 20), np.random.default_rng(1)
    frames = np.array([10, 100, 300])
    for fit, grows in ((STVF.fit, np.sqrt(frames)), (SIEM.fit, np.ones(3))):
        there = fit(y)
        flat, start = there.forward(y)
        away = sphere.distance(there.inverse(flat + 1e-3 * rng.normal(size=flat.shape), start), y).mean(axis=0)
        expected = 20 * np.sqrt(np.pi / 2) * 1e-3 * grows
        assert np.all(np.abs(away[frames] / expected - 1) < 0.15), fit


def test_the_moving_frame_turns_no_more_than_the_mean_course():
    y = walks(5, 60, 4)
    there = SIEM.fit_moving(y)
    step = np.diff(there.plane, axis=0)
    moved = sphere.angle(there.reference[1:], there.reference[:-1])
    assert np.all(np.linalg.norm(step, axis=-1) <= moved[..., None] + 1e-12)
    assert np.abs(there.forward(y)[0].mean(axis=0)).max() < 1e-11


def test_another_number_of_times_than_the_moving_mean_is_refused():
    with pytest.raises(ValueError, match="found 39 times, the moving mean has 40"):
        SIEM.fit_moving(walks()).forward(walks()[:, :39])
