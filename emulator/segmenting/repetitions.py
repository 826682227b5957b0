"""Where a movement rests: stillness, and the posture that it comes back to.

A take as points of posture space, and how fast it moves through it.

Repetitions in a long take: away from the posture of rest and back to it, however long the rests between them last.

How far the body is from its posture of rest goes up and down once a repetition. What does not come back most of the
way (standing between rising and sitting down) parts no repetition, whether it is held or not. A repetition begins with
the last frame of rest before it and ends with the first after it; without a rest between two, both at the nearest
frame to it. Beyond the seed, which knows cycles without rests only.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from emulator.motion import heading_rad, turn
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton

STILL_SHARE = 0.13
"""Slower than this share of the take's typical speed is still."""
SHORTEST_S = 0.15
"""A rest lasts at least this long."""
MOST_FRAMES = 1200
"""So many frames are looked at for the posture where most of them are."""
NEAR_SHARE = 0.15
"""Postures are near within this share of the take's span."""


def still_frames(speed: np.ndarray, typical: float, rate_hz: float) -> np.ndarray:
    """(T,) whether the body is still: slow, for SHORTEST_S at least; shorter stirs in between do not count."""
    from scipy.ndimage import binary_closing, binary_opening

    size = max(1, round(SHORTEST_S * rate_hz))
    slow = np.pad(speed < STILL_SHARE * typical, size, mode="edge")
    open_ones = binary_opening(binary_closing(slow, np.ones(max(1, size // 2))), np.ones(size))
    return np.asarray(open_ones[size:-size] & (speed < 2 * STILL_SHARE * typical))


def home_posture(points: np.ndarray, still: np.ndarray) -> np.ndarray:
    """The posture (m,) where the body rests most; where it is never still, the one that it is nearest to most often.

    Of several resting places one counts more in which the take begins or ends.
    """
    frames = np.flatnonzero(still) if still.any() else np.arange(len(points))
    frames = frames[np.linspace(0, len(frames) - 1, min(len(frames), MOST_FRAMES)).astype(int)]
    chosen = points[frames]
    from scipy.spatial.distance import cdist

    near = cdist(chosen, chosen) < NEAR_SHARE * span(points)
    share = near.mean(axis=1)
    for end in (0, -1):
        share = share + 0.25 * (np.linalg.norm(chosen - points[end], axis=1) < NEAR_SHARE * span(points))
    best = int(np.argmax(share))
    return np.asarray(chosen[near[best]].mean(axis=0))


def span(points: np.ndarray) -> float:
    """How far postures (T, m) lie apart: twice the 95th percentile of the distance from their median."""
    away = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    return 2.0 * float(np.quantile(away, 0.95))


FEWEST_FRAMES = 8
HALF_WINDOW_S = 0.1
"""A speed compares the mean posture of this time before with that after: tracking noise is averaged away."""


def postures(take: Take) -> np.ndarray:
    """Unit directions of all bones with the heading taken out, (T, 3 B): what place, size and turning leave alone.

    Raises ValueError that names the take and says what to do: markers, gaps, too few frames, a body that stands still.
    """
    if take.parents is None:
        raise ValueError(f"take {take.name}: found markers, expected joints: import with a marker set first")
    if take.n_frames < FEWEST_FRAMES:
        frames = f"{take.n_frames} frame{'s' if take.n_frames != 1 else ''}"
        raise ValueError(f"take {take.name}: found {frames}, expected {FEWEST_FRAMES} or more")
    gaps = np.argwhere(~np.isfinite(take.positions_m).all(axis=2))
    if len(gaps):
        frame, joint = (int(i) for i in gaps[0])
        where = f"the first at frame {frame}, {take.names[joint]}"
        raise ValueError(f"take {take.name}: found {len(gaps)} gaps ({where}), expected none: clean it first")
    skeleton = Skeleton(take.names, take.parents)
    try:
        heading = heading_rad(skeleton, take.positions_m)
        points = turn(skeleton.directions(take.positions_m), -heading[:, None]).reshape(take.n_frames, -1)
    except ValueError as error:
        raise ValueError(f"take {take.name}: {error}") from None
    if np.ptp(points, axis=0).max() < 1e-9:
        raise ValueError(f"take {take.name}: the body does not move, expected a movement to cut")
    return points


def smoothed(points: np.ndarray, half: int) -> np.ndarray:
    """Running means over 2 half + 1 frames, fewer at the ends; (T, m)."""
    if half < 1:
        return points
    sums = np.concatenate([np.zeros_like(points[:1]), np.cumsum(points, axis=0)])
    at = np.arange(len(points))
    low, high = np.maximum(at - half, 0), np.minimum(at + half + 1, len(points))
    shape = (-1, *[1] * (points.ndim - 1))
    return (sums[high] - sums[low]) / (high - low).reshape(shape)


def speed_per_s(points: np.ndarray, rate_hz: float) -> np.ndarray:
    """(T,) speed through posture space, what noise feigns (from third differences) taken off."""
    half = max(1, round(HALF_WINDOW_S * rate_hz))
    extended = np.pad(points, ((half, half), (0, 0)), mode="reflect", reflect_type="odd")
    sums = np.concatenate([np.zeros_like(extended[:1]), np.cumsum(extended, axis=0)])
    at = np.arange(len(points)) + half
    step = (sums[at + 1 + half] - sums[at + 1] - sums[at] + sums[at - half]) / half
    square = np.einsum("tm,tm->t", step, step) - 2 * noise_square(points) / half
    return np.sqrt(np.maximum(square, 0.0)) / (half + 1) * rate_hz


def noise_square(points: np.ndarray) -> float:
    """Variance of tracking noise, summed over the coordinates, from their third differences."""
    if len(points) < 4:
        return 0.0
    third = np.abs(np.diff(points, n=3, axis=0)) / np.sqrt(20.0)
    return float(np.sum((np.median(third, axis=0) / 0.6745) ** 2))


def typical_speed(speed: np.ndarray) -> float:
    """The mean speed over the way (not over time), which stillness does not change."""
    return float(np.sum(speed**2) / max(float(np.sum(speed)), 1e-300))


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
