import numpy as np
import pytest
from human_plans import LINE, planned

from opsim.engine.floor import run_plan
from opsim.log import WORK

HOUR_S = 3600.0


def test_the_shift_of_a_row_is_that_of_the_clock_when_it_began():
    """Amplitude 0.1, peak at 09:00, start at 06:00: -0.1 cos(2 pi (06:00 + now - 09:00) / 24 h)."""
    log = run_plan(planned(LINE, "human: {circadian: {amplitude: 0.1, peak: '09:00'}}"))
    work = log["kind"] == WORK
    clock_s = 6 * HOUR_S + log["start_s"][work]
    assert log["pace_shift"][work] == pytest.approx(-0.1 * np.cos(2 * np.pi * (clock_s - 9 * HOUR_S) / (24 * HOUR_S)))


def test_a_run_that_starts_at_the_peak_is_quickest_at_its_start():
    log = run_plan(
        planned(LINE.replace("Mon 06:00", "Tue 16:00"), "human: {circadian: {amplitude: 0.1, peak: '16:00'}}")
    )
    assert log["pace_shift"][np.flatnonzero(log["kind"] == WORK)[0]] == pytest.approx(-0.1, abs=1e-4)
