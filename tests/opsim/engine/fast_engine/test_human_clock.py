"""The time of day on both engines."""

import pytest
from human_plans import shipped
from twins import of_both

from opsim.log import WORK


@pytest.mark.parametrize("amplitude", [0, 0.05, 1])
def test_people_go_by_the_clock_as_in_the_reference(amplitude):
    log = of_both(shipped("night_shift", 8.0, f"human: {{circadian: {{amplitude: {amplitude}, peak: '16:48'}}}}"))
    assert bool(log.of(WORK)["pace_shift"].any()) == bool(amplitude)
