import numpy as np
from made_scene import run_of

from opsim.ergonomics.scores.scoring import Scores
from opsim.ergonomics.shift.day import fold
from opsim.viewer.scores import rula


class Kept:
    """All frames with their scores, for a naive twin."""

    def __init__(self):
        self.frames = []

    def add(self, frames, scores: Scores):
        for k in range(len(frames)):
            self.frames.append((frames.worker, frames.start_s[k], frames.end_s[k], *scores.rula[k].tolist()))


def test_scores_are_those_of_the_frame_there_is_at_each_moment():
    from dataclasses import replace

    run, low_s, high_s = run_of("walking_cell"), 600.0, 660.0
    found, kept = rula(run.log(), run.plan, low_s, high_s), Kept()
    options = replace(run.plan.ergonomics, rate_hz=4.0)
    fold(run.log(), replace(run.plan, warm_up_s=low_s, horizon_s=high_s, ergonomics=options), [kept])
    assert found.shape == (2, 240) and (found > 0).mean() > 0.5
    for worker in range(2):
        for i in range(0, 240, 3):
            at_s = low_s + (i + 0.5) / 4
            here = [
                (low, high) for w, start_s, end_s, low, high in kept.frames if w == worker and start_s <= at_s < end_s
            ]
            meant = here[0][0] | here[0][1] << 4 if here and here[0][0] > 0 else 0
            assert found[worker, i] == meant


def test_without_any_posture_there_are_no_scores():
    run = run_of("serial_line", 300.0)
    assert rula(run.log(), run.plan, 0.0, 300.0) is None
    assert isinstance(rula(run_of("walking_cell").log(), run_of("walking_cell").plan, 0.0, 60.0), np.ndarray)
