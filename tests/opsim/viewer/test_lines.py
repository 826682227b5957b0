import numpy as np
from made_scene import run_of, scene

from opsim.viewer.pose import joints_m


def test_who_works_on_a_moving_line_goes_with_it():
    shown, line = scene("moving_line"), run_of("moving_line").plan.lines[0]
    segments = shown.segments
    work = np.flatnonzero((segments.state == shown.states.index("work")) & (segments.end_s - segments.start_s > 5.0))
    speed = segments.dx_m[work] / (segments.end_s - segments.start_s)[work]
    assert np.median(speed) == line.speed_m_per_s or abs(np.median(speed) - line.speed_m_per_s) < 1e-9


def test_nobody_jumps_on_a_moving_line():
    shown = scene("moving_line")
    segments = shown.segments
    for worker in range(len(shown.workers)):
        for row in range(segments.first[worker], segments.first[worker + 1] - 1):
            one, two = (joints_m(shown, worker, segments.end_s[row] + past_s) for past_s in (-1e-6, 1e-6))
            assert np.linalg.norm((one - two)[0]) < 0.1
