"""How the day goes for bodies: each worker's scores, minute by minute."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.fold import fold
from opsim.ergonomics.shift.stretch import Frames
from opsim.log import EventLog
from opsim.plan import Plan

MINUTE_S = 60.0


@dataclass(frozen=True)
class Timeline:
    """W workers, M minutes; every array but edges is (W, M).

    edge_s : (M + 1,) seconds of the run at which minutes begin and the last one ends
    known_s, unknown_s : seconds of work (walking, waiting) whose posture is known, and not; the rest is none of these
    rula_low, rula_high : mean over the known time, nan where there is none
    from_5_s, from_5_at_most_s : known seconds at RULA 5 or more, at least and at most
    """

    edge_s: np.ndarray
    known_s: np.ndarray
    unknown_s: np.ndarray
    rula_low: np.ndarray
    rula_high: np.ndarray
    from_5_s: np.ndarray
    from_5_at_most_s: np.ndarray


def timeline(log: EventLog, plan: Plan) -> Timeline:
    """The window of a replication, minute by minute. Raises what ``days`` raises."""
    minutes = Minutes(plan)
    fold(log, plan, [minutes])
    return minutes.close()


class Minutes:
    """A fold that sums scores by worker and minute of the run; a frame that lies in two minutes is shared out."""

    def __init__(self, plan: Plan):
        low, high = plan.window_s
        self._first, last = int(low // MINUTE_S), int(np.ceil(high / MINUTE_S))
        self._sums = np.zeros((len(plan.workers), 6, max(last - self._first, 1)))

    def add(self, frames: Frames, scores: Scores) -> None:
        """The next stretch."""
        frame, minute, seconds = _by_minute(frames)
        known = scores.rula[frame, 0] > 0
        low, high = (np.where(known, scores.rula[frame, bound], 0) for bound in (0, 1))
        for at, counted in enumerate((known, ~known, low, high, low >= 5, high >= 5)):
            n = self._sums.shape[2]
            self._sums[frames.worker, at] += np.bincount(minute - self._first, seconds * counted, n)[:n]

    def close(self) -> Timeline:
        """All that was summed."""
        known_s, unknown_s, low, high, from_5_s, at_most_s = np.moveaxis(self._sums, 1, 0)
        edge_s = MINUTE_S * (self._first + np.arange(self._sums.shape[2] + 1))
        some_s = np.where(known_s > 0, known_s, np.nan)
        return Timeline(edge_s, known_s, unknown_s, low / some_s, high / some_s, from_5_s, at_most_s)


def _by_minute(frames: Frames) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frames cut at full minutes, (K,) each: which frame, in which minute of the run, for how many seconds."""
    first = np.floor(frames.start_s / MINUTE_S).astype(int)
    last = np.maximum(np.ceil(frames.end_s / MINUTE_S).astype(int) - 1, first)
    times = last - first + 1
    frame = np.repeat(np.arange(len(frames)), times)
    minute = first[frame] + np.arange(frame.size) - np.repeat(np.cumsum(times) - times, times)
    begin_s = np.maximum(frames.start_s[frame], MINUTE_S * minute)
    end_s = np.minimum(frames.end_s[frame], MINUTE_S * (minute + 1))
    return frame, minute, np.where(times[frame] == 1, frames.seconds[frame], np.maximum(end_s - begin_s, 0.0))
