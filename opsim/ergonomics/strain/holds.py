"""Postures that are held: an angle stays within a band, out of neutral, across performances. No frame tells it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.ergonomics.columns import AT
from opsim.ergonomics.strain.arm_angle import arm_angle_deg

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
        from opsim.ergonomics.kernels.holding import held

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
