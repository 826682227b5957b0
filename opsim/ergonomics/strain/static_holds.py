"""Each posture that is held, from when on, how long and at which angle: marks of frames made into runs.

What share of strength a posture asks, from one angle: the weight of what leans, against the joint that holds it.

Movements beyond an angle, counted from one stretch of frames to the next.

How far an upper arm is from hanging, and whether it is behind the trunk.

Postures that are held: an angle stays within a band, out of neutral, across performances. No frame tells it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.anthropometry import HEIGHT_M, MASS_KG, segments_of, strength_nm


@dataclass(frozen=True, slots=True, eq=False)
class Runs:
    """H holds of one region, each (H,): whose, from when on, how long, and the mean angle in degrees."""

    worker: np.ndarray
    start_s: np.ndarray
    seconds: np.ndarray
    angle_deg: np.ndarray


class RunsOf:
    """Puts the held frames of one region together, over the edges of stretches too.

    Held frames one after the other may be several holds: a stoop of 25 degrees, one of 70, and one of 25 again. A hold
    stays within ``band_deg``; where frames do not, the longest part that does is one, then the longest of what is left
    before and after it, and so on. So the longest hold is the longest there is, and no second belongs to two.

    gap_s : longer than this without a frame, and a hold is over
    """

    def __init__(self, band_deg: float, gap_s: float):
        self._band_deg, self._gap_s = band_deg, gap_s
        self._open: list[np.ndarray] = []
        self._parts: list[np.ndarray] = [np.empty((0, 4))]
        self._n_frames = 0

    def add(
        self, worker: int, start_s: np.ndarray, seconds: np.ndarray, angle_deg: np.ndarray, held: np.ndarray
    ) -> None:
        """The next stretch, each (N,), in the order of time. What is held at its end is kept until it is over."""
        at = np.flatnonzero(held)
        if at.size:
            who, number = np.full(at.size, worker, float), self._n_frames + at
            self._open.append(np.stack([who, number, start_s[at], seconds[at], angle_deg[at]], axis=1))
        self._n_frames += held.size
        if self._open and held.size and not held[-1]:
            self._cut()

    def runs(self) -> Runs:
        """All of them, in the order in which they came."""
        if self._open:
            self._cut()
        worker, start_s, seconds, angle_deg = np.concatenate(self._parts).T
        return Runs(worker.astype(int), start_s, seconds, angle_deg)

    def _cut(self) -> None:
        """The held frames that are kept become holds."""
        from opsim.ergonomics.kernels.static_holds import hold_parts

        frames, self._open = np.concatenate(self._open), []
        worker, number, start_s, seconds, angle_deg = np.ascontiguousarray(frames.T)
        late = start_s[1:] - (start_s + seconds)[:-1] > self._gap_s
        apart = late | (np.diff(worker) != 0) | (np.diff(number) > 1)
        edges, begins = np.r_[0, np.flatnonzero(apart) + 1, worker.size], np.zeros(worker.size, bool)
        hold_parts(angle_deg, seconds, edges, self._band_deg, begins)
        first = np.flatnonzero(begins)
        lasting = np.add.reduceat(seconds, first)
        mean_deg = np.add.reduceat(seconds * angle_deg, first) / lasting
        self._parts.append(np.stack([worker[first], start_s[first], lasting, mean_deg], axis=1))


G = 9.80665
TRUNK, UPPER_ARM, FOREARM, HEAD = 0.30, 0.186, 0.146, 0.36
"""Shares of body height: hips to neck, shoulder to elbow, elbow to wrist; hips to the centre of the head. Source:
Drillis & Contini 1966, as in Winter, Biomechanics and motor control of human movement, figure 4.1; trunk and head
rounded."""


def hold_share(region: str, angle_deg: np.ndarray | float, body: Any = None) -> np.ndarray:
    """Share of the strength of the back (``trunk``) or a shoulder (``left_arm``, ``right_arm``), 0 to 1, for its angle.

    Statics of a trunk leaning with arms and head, and of one straight arm: a bent elbow asks for less. No load.
    body : mass_kg, height_m, sex, age_years, None where not known
    """
    mass = _said(body, "mass_kg", MASS_KG)
    height, segments = _said(body, "height_m", HEIGHT_M), segments_of(getattr(body, "sex", None))
    arm = segments.upper_arm + segments.forearm + segments.hand
    if region == "trunk":
        lever = TRUNK * (segments.back * segments.back_centre + 2.0 * arm) + HEAD * segments.head
        strength = strength_nm("back", body)
    else:
        lower = FOREARM * (segments.forearm * segments.forearm_centre + segments.hand)
        lever = UPPER_ARM * (segments.upper_arm * segments.upper_arm_centre + segments.forearm + segments.hand) + lower
        strength = strength_nm("shoulder", body)
    turning = np.abs(np.sin(np.deg2rad(np.asarray(angle_deg, float))))
    return np.minimum(G * mass * height * lever * turning / strength, 1.0)


def _said(body: Any, name: str, otherwise: float) -> float:
    said = getattr(body, name, None)
    return otherwise if said is None else float(said)


BACK_DEG = 5.0
"""A movement is over when the angle has come back so far below where it counts from. Source: design."""


class Movements:
    """Of one worker: when an angle goes beyond a threshold, having been below it by ``back_deg`` before."""

    def __init__(self, beyond_deg: float, back_deg: float = BACK_DEG):
        self._beyond_deg, self._back_deg = beyond_deg, back_deg
        self._beyond = False

    def next(self, angle_deg: np.ndarray) -> np.ndarray:
        """(N,) bool: the frames of the next stretch with which a movement begins.

        What begins a day beyond the threshold counts as a movement, and what begins a later stretch there does not;
        frames between, and unknown ones, change nothing.
        """
        angle = np.asarray(angle_deg, float)
        low_deg = self._beyond_deg - self._back_deg
        state = np.r_[1 if self._beyond else -1, np.where(angle > self._beyond_deg, 1, -1 * (angle < low_deg))]
        state = state[np.maximum.accumulate(np.where(state != 0, np.arange(state.size), 0))]
        self._beyond = bool(state[-1] == 1)
        return (state[1:] == 1) & (state[:-1] == -1)


def movements(angle_deg: np.ndarray, beyond_deg: float, back_deg: float = BACK_DEG) -> np.ndarray:
    """(N,) bool: the same of a whole day."""
    return Movements(beyond_deg, back_deg).next(angle_deg)


BEHIND_DEG = 5.0
"""An elbow so far behind the plane of its trunk is behind it, for how a neutral is measured. Source: design."""


def arm_angle_deg(measures: np.ndarray, side: str) -> np.ndarray:
    """(N,) elevation of the upper arm of a side, ``left`` or ``right``, from measures (N, COLUMNS); less than 0 behind
    the trunk.

    Behind is where flexion is backward, not beyond level, and the arm leaves the plane of the trunk by more than
    ``BEHIND_DEG``: sin = cos(abduction) sin(flexion). The sign of flexion alone would turn arms around that are held to
    the side, by a wink of noise. Where flexion or abduction is not known, arms are taken as before the trunk.
    """
    at = {name: np.asarray(measures[:, AT[f"{side}_arm_{name}"]], float) for name in ("flexion", "abduction")}
    flexion, elevation = at["flexion"], np.asarray(measures[:, AT[f"{side}_arm_elevation"]], float)
    out_of_plane = np.cos(np.deg2rad(at["abduction"])) * np.sin(np.deg2rad(flexion))
    behind = (flexion > -90.0) & (out_of_plane < -np.sin(np.deg2rad(BEHIND_DEG)))
    return np.where(behind, -elevation, elevation)


CHANNELS = {
    "trunk": ("trunk_flexion",),
    "left_arm": ("left_arm_elevation",),
    "right_arm": ("right_arm_elevation",),
    "neck": ("neck_flexion",),
}
"""Regions whose holding is looked at, and the measures whose sum tells it."""
REGIONS = {**CHANNELS, "head": ("trunk_flexion", "neck_flexion")}
"""The same, and how far the head leans against upright, as ISO 11226 and EN 1005-4 ask."""

ARMS = {"left_arm": "left", "right_arm": "right"}


@dataclass(frozen=True, slots=True)
class Holding:
    """When a posture counts as held.

    least_s : longer than this. 4 s: ISO 11226:2000, 3 (static working posture: maintained longer than 4 s);
              60 s: McAtamney & Corlett 1993, RULA (muscle use); Hignett & McAtamney 2000, REBA (activity)
    band_deg : the largest angle is within so many degrees of the least. Source: design; no standard says a number
    gap_s   : longer than this without a known posture, and the hold is over. Source: design
    trunk_deg, arm_deg, neck_deg, head_deg : up to here the region is neutral and nothing is held
    backward_deg : the same backward, of every region, and arms behind the trunk are told from those before it;
              None: as far as forward, and arms by how far they are from hanging, whichever way
    """

    least_s: float
    band_deg: float = 10.0
    gap_s: float = 0.5
    trunk_deg: float = 20.0
    arm_deg: float = 20.0
    neck_deg: float = 25.0
    head_deg: float = 25.0
    backward_deg: float | None = None

    def neutral_deg(self, region: str) -> tuple[float, float]:
        """Of one of ``REGIONS``: how far backward, and forward, both as positive numbers."""
        forward = {"trunk": self.trunk_deg, "neck": self.neck_deg, "head": self.head_deg}.get(region, self.arm_deg)
        return forward if self.backward_deg is None else self.backward_deg, forward


STATIC = Holding(60.0, neck_deg=10.0)
"""Muscle use of RULA and activity of REBA. Neutral is where RULA's scores of an arm and a neck are 1; its trunk is 1
only at 0 degrees, at which nobody stands, so 20 as in ISO 11226."""
STATIC_WORK = Holding(4.0, backward_deg=5.0)
"""Static working postures. Neutral is what ISO 11226:2000 (tables 1, 3, 4) accepts without a holding time: forward 20
degrees of trunk and arms and 25 of head and neck; backward 0 without support, and 5 here, as ``Iso11226`` says."""


def region_angles_deg(measures: np.ndarray, regions: Iterable[str], behind: bool = False) -> np.ndarray:
    """(N, regions) degrees by which the angles of ``REGIONS`` are told, from measures (N, COLUMNS).

    behind : whether those of arms behind the trunk are less than 0, as ``arm_angle_deg`` says
    """
    found = [sum(np.asarray(measures, float)[:, AT[name]] for name in REGIONS[region]) for region in regions]
    if behind:
        found = [arm_angle_deg(measures, ARMS[one]) if one in ARMS else angle for one, angle in zip(regions, found)]
    return np.stack(found, axis=1)


class StaticMarker:
    """Marks the held frames of workers' days, stretch after stretch; keeps no more than is still undecided.

    Whether the last minute of a stretch is held is known only when what follows is: ``push`` gives the marks of those
    stretches, in order, that have become certain, and ``close`` those of the rest.
    """

    def __init__(self, holding: Holding = STATIC, regions: Iterable[str] = tuple(CHANNELS)):
        self.holding, self.regions = holding, tuple(regions)
        self._worker: int | None = None
        self._waiting: list[np.ndarray] = []
        self._start_s, self._end_s = np.empty(0), np.empty(0)
        self._values = np.empty((0, len(self.regions)))

    def push(self, worker: int, start_s: np.ndarray, seconds: np.ndarray, measures: np.ndarray) -> list[np.ndarray]:
        """The next stretch of frames of a worker, in time order: start_s, seconds (N,), measures (N, COLUMNS).

        Returns (N, regions) bool for each stretch that is certain now, the oldest first; an earlier worker's all are.
        """
        certain = [] if worker == self._worker else self.close()
        self._worker = worker
        start_s, end_s = np.asarray(start_s, float), np.asarray(start_s, float) + np.asarray(seconds, float)
        self._start_s, self._end_s = np.r_[self._start_s, start_s], np.r_[self._end_s, end_s]
        values = region_angles_deg(measures, self.regions, self.holding.backward_deg is not None)
        self._values = np.concatenate([self._values, values])
        self._waiting.append(np.zeros((start_s.size, len(self.regions)), bool))
        self._mark()
        return certain + self._certain()

    def close(self) -> list[np.ndarray]:
        """The marks of all stretches that are still waited for; what comes next is another day."""
        waited_for, self._worker, self._waiting = self._waiting, None, []
        self._start_s, self._end_s, self._values = self._start_s[:0], self._end_s[:0], self._values[:0]
        return waited_for

    def _mark(self) -> None:
        """Write into the marks that are waited for what the frames that are kept tell."""
        from opsim.ergonomics.kernels.static_holds import held

        said = self.holding
        for place, region in enumerate(self.regions):
            mark, value = np.zeros(self._start_s.size, bool), np.ascontiguousarray(self._values[:, place])
            bounds = (*said.neutral_deg(region), said.band_deg, said.least_s, said.gap_s)
            held(value, self._start_s, self._end_s, *bounds, mark)
            self._write(place, mark)

    def _write(self, place: int, mark: np.ndarray) -> None:
        """The frames that are kept are the last ones of the stretches that are waited for."""
        end = mark.size
        for marks in reversed(self._waiting):
            begin = max(end - len(marks), 0)
            marks[len(marks) - (end - begin) :, place] |= mark[begin:end]
            end = begin

    def _certain(self) -> list[np.ndarray]:
        """Take out the stretches that nothing to come can change, and keep the frames that still matter."""
        if self._end_s.size:
            from_s = self._end_s[-1] - self.holding.least_s - self.holding.gap_s
            kept = slice(int(np.searchsorted(self._end_s, from_s, side="left")), None)
            self._start_s, self._end_s, self._values = self._start_s[kept], self._end_s[kept], self._values[kept]
        left, n = self._start_s.size, len(self._waiting)
        while n and left > 0:
            n -= 1
            left -= len(self._waiting[n])
        certain, self._waiting = self._waiting[:n], self._waiting[n:]
        return certain


def marked(stretches: Iterable[Any], holding: Holding = STATIC) -> Iterator[tuple[Any, np.ndarray]]:
    """Each stretch with (N, regions) bool, in which frames a region of ``CHANNELS`` is held; a stretch late, at least.

    stretches : in time order by worker, each with worker (one number, or (N,) all the same), start_s, seconds, measures
    """
    marker, late = StaticMarker(holding), deque[Any]()
    for stretch in stretches:
        late.append(stretch)
        ranks = np.atleast_1d(stretch.worker)
        for marks in marker.push(
            int(ranks[0]) if ranks.size else -1, stretch.start_s, stretch.seconds, stretch.measures
        ):
            yield late.popleft(), marks
    for marks in marker.close():
        yield late.popleft(), marks
