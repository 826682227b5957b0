"""Low-pass: tracking noise taken out of the joints that have any, by a Butterworth filter run both ways.

Source: Winter, Biomechanics and Motor Control of Human Movement, 4th ed., 3.4.4.2 (order 2, both ways, so that nothing
is shifted in time; the cut-off of each way, warped as tan(pi hz / rate), raised by 1 / 0.802 since two cut twice) and
3.4.4.3, residual analysis: what a filter takes out, over its cut-off, is a straight line where it is noise only; drawn
on to 0 Hz the line says how much noise there is, and the cut-off is where the filter takes out that much. How much
noise there is at all is asked of eighth differences, in which little of a movement is left; a smooth joint stays.
"""

from __future__ import annotations

from dataclasses import replace
from math import comb

import numpy as np

from emulator.cleaning.report import Repair
from emulator.cleaning.settings import CleaningSettings
from emulator.recordings.take import Take

BOTH_WAYS = 0.802
FEWEST_FRAMES = 30
LOWEST_HZ = 3.0
"""No cut-off is lower: a foot that stands has none of its own, but may be about to move."""
TAIL = (0.5, 0.9)
"""The part of the frequencies below the highest cut-off in which there is noise only."""
HIGHEST = 0.76
"""Of half the frame rate."""
N_CUT_OFFS = 24
ORDER = 8


def smoothed(take: Take, settings: CleaningSettings) -> tuple[Take, tuple[Repair, ...]]:
    """The take with its noisy joints filtered, and of each what was taken out, root mean square in mm."""
    if settings.low_pass == "off" or take.n_frames < FEWEST_FRAMES or not np.isfinite(take.positions_m).all():
        return take, ()
    noise_m = coordinate_noise_m(take.positions_m)
    positions, repairs = take.positions_m.copy(), []
    for joint in np.flatnonzero(noise_m > settings.noise_m).tolist():
        cut_off_hz, how = settings.cut_off_hz, "as asked"
        if cut_off_hz is None:
            cut_off_hz, how = (
                residual_analysis(take.positions_m[:, joint], take.rate_hz)[0],
                "found by residual analysis",
            )
        if cut_off_hz > highest_hz(take.rate_hz):
            cut_off_hz, how = highest_hz(take.rate_hz), f"{how}, but no higher at {take.rate_hz:g} frames a second"
        positions[:, joint] = filtered(take.positions_m[:, joint], take.rate_hz, cut_off_hz)
        taken_mm = 1000 * float(np.sqrt(np.mean((positions[:, joint] - take.positions_m[:, joint]) ** 2)))
        words = f"shakes by {1000 * noise_m[joint]:.1f} mm a coordinate; low-pass at {cut_off_hz:.1f} Hz ({how})"
        repairs.append(Repair(take.name, "noise", (take.names[joint],), 0, take.n_frames - 1, taken_mm, "mm", words))
    return (replace(take, positions_m=positions) if repairs else take), tuple(repairs)


def coordinate_noise_m(positions_m: np.ndarray) -> np.ndarray:
    """(J,) standard deviation of the noise a coordinate, from the medians of eighth differences of (T, J, 3).

    White noise comes out of differences of order n times the root of (2n over n); walking at 30 frames a second
    feigns 1 mm in fourth differences.
    """
    high = np.abs(np.diff(positions_m, n=ORDER, axis=0)) / np.sqrt(comb(2 * ORDER, ORDER))
    return np.asarray(np.sqrt(np.mean((np.median(high, axis=0) / 0.6745) ** 2, axis=-1)))


def filtered(positions_m: np.ndarray, rate_hz: float, cut_off_hz: float) -> np.ndarray:
    """Positions (T, ...) through the filter; 3 dB less at ``cut_off_hz`` after both ways."""
    from scipy.signal import butter, sosfiltfilt

    raised = np.arctan(np.tan(np.pi * cut_off_hz / rate_hz) / BOTH_WAYS)
    sections = butter(2, raised / (np.pi / 2), output="sos")
    return np.asarray(sosfiltfilt(sections, positions_m, axis=0))


def residual_analysis(positions_m: np.ndarray, rate_hz: float) -> tuple[float, float]:
    """Cut-off in Hz and noise in metres a coordinate (root mean square over all) of positions (T, ...)."""
    highest = highest_hz(rate_hz)
    cut_offs = np.linspace(min(LOWEST_HZ, highest / 4), highest, N_CUT_OFFS)
    residual = np.array([np.sqrt(np.mean((filtered(positions_m, rate_hz, hz) - positions_m) ** 2)) for hz in cut_offs])
    tail = (cut_offs >= TAIL[0] * highest) & (cut_offs <= TAIL[1] * highest)
    slope, noise_m = np.polyfit(cut_offs[tail], residual[tail], 1)
    if slope >= 0 or noise_m <= 0:
        return highest, 0.0
    falling = np.minimum.accumulate(residual)[::-1]
    return float(np.interp(noise_m, falling, cut_offs[::-1])), float(noise_m)


def highest_hz(rate_hz: float) -> float:
    """The highest cut-off that is used: the filter needs room below half the frame rate."""
    return HIGHEST * rate_hz / 2
