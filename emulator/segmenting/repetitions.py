"""Repetitions in a long take: away from the posture of rest and back to it, however long the rests between them last.

How far the body is from its posture of rest goes up and down once a repetition. What does not come back most of the
way (standing between rising and sitting down) parts no repetition, whether it is held or not. A repetition begins with
the last frame of rest before it and ends with the first after it; without a rest between two, both at the nearest
frame to it. Beyond the seed, which knows cycles without rests only.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from emulator.segmenting.home import home_posture, still_frames
from emulator.segmenting.postures import smoothed, speed_per_s, typical_speed

PROMINENCE = 0.4
"""Of the usual distance: so far the body comes back between two repetitions."""
ZONE = 0.5
"""Still is rest below this share of the way from the nearest frame to the furthest."""
SMOOTH_S = 0.05
GONE = 0.06
"""Of the typical speed: slower than this a movement is over."""
ONSET_S = 0.06
"""Half the window over which the speed is averaged where the onset of a movement is followed into its rest."""


@dataclass(frozen=True, eq=False)
class Repetitions:
    """start, stop (R,) first and last frame of each repetition, furthest (R,) the frame furthest from rest.

    away     : (T,) distance from the posture of rest
    rests    : whether the body was still before the first, between any two (R - 1) and after the last: (R + 1,) bool
    left_out : what was found and is no whole repetition, in words
    """

    start: np.ndarray
    stop: np.ndarray
    furthest: np.ndarray
    away: np.ndarray
    rests: np.ndarray
    left_out: tuple[str, ...] = ()


def repetitions(points: np.ndarray, rate_hz: float) -> Repetitions:
    """The repetitions of a movement (T, m) at ``rate_hz`` frames a second: as many as there are, also none."""
    from scipy.signal import find_peaks

    smooth = smoothed(points, round(SMOOTH_S * rate_hz))
    speed = speed_per_s(points, rate_hz)
    still = still_frames(speed, typical_speed(speed), rate_hz)
    away = np.linalg.norm(smooth - home_posture(smooth, still), axis=1)
    padded = np.concatenate([[away.min()], away, [away.min()]])  # so that the ends can be peaks too
    usual = _usual(padded)
    peaks = find_peaks(padded, prominence=PROMINENCE * usual)[0] - 1
    course = smoothed(speed, round(ONSET_S * rate_hz)) / typical_speed(speed)
    between = [0, *(int(a + np.argmin(away[a : b + 1])) for a, b in itertools.pairwise(peaks)), len(away) - 1]
    reach = [0, *(int(peak) for peak in peaks), len(away) - 1]
    cuts = []
    for i, peak in enumerate(peaks):
        start = _edge(away, course, still, np.arange(peak, reach[i] - 1, -1), between[i])
        stop = _edge(away, course, still, np.arange(peak, reach[i + 2] + 1), between[i + 1])
        cuts.append((start[0], stop[0], start[1], stop[1]))
    return _whole(cuts, peaks, away, rate_hz)


def _usual(padded: np.ndarray) -> float:
    """The usual height of the peaks that stand out by a quarter of the highest: a median, so that one may be odd."""
    from scipy.signal import find_peaks

    peaks, found = find_peaks(padded, prominence=0.25 * float(np.ptp(padded)))
    return float(np.median(found["prominences"])) if len(peaks) else float(np.ptp(padded))


def _edge(away: np.ndarray, course: np.ndarray, still: np.ndarray, way: np.ndarray, valley: int) -> tuple[int, bool]:
    """The first frame of rest on the way from a peak to the next, or the valley between; and whether there is rest.

    From the first still frame on the movement is followed for as long as it goes on dying down, to ``GONE``.
    """
    zone = away[way] < away[valley] + ZONE * (away[way[0]] - away[valley])
    rest = np.flatnonzero(zone & still[way])
    if not len(rest):
        return valley, False
    further = course[way[rest[0] :]]
    dying = (np.diff(further) < 0) & (further[:-1] > GONE)
    onward = len(dying) if dying.all() else int(np.argmin(dying))
    return int(way[rest[0] + onward]), True


def _whole(cuts: list[tuple[int, int, bool, bool]], peaks: np.ndarray, away: np.ndarray, rate_hz: float) -> Repetitions:
    """Those that begin and end near rest; one that the take cuts off is left out, with a word on it."""
    said, keep = [], []
    for number, (start, stop, before, after) in enumerate(cuts):
        height = away[peaks[number]]
        cut_off = [
            word
            for word, frame, rests, end in (("begins", start, before, 0), ("ends", stop, after, len(away) - 1))
            if not rests and frame == end and away[frame] > ZONE * height
        ]
        if cut_off:
            said.append(f"a movement at {peaks[number] / rate_hz:.2f} s {' and '.join(cut_off)} outside the take")
        else:
            keep.append(number)
    rests = [cuts[number][2] for number in keep] + [cuts[number][3] for number in keep[-1:]]
    frames = np.array([cuts[number][:2] for number in keep], dtype=int).reshape(-1, 2)
    furthest = peaks[keep].astype(int)
    return Repetitions(frames[:, 0], frames[:, 1], furthest, away, np.array(rests, dtype=bool), tuple(said))
