"""Errors by fatigue on both engines."""

import numpy as np
import pytest
from human_plans import LINE, planned
from twins import of_both

from opsim.log import BAD, FINISH, REWORK

INSPECTED = LINE.replace(
    "c: {at: three, tasks: [paint], buffer: 2}",
    "c: {at: three, tasks: [paint], buffer: 2, yield: 0.95, inspect: {finds: 0.5, then: {rework: c}}}",
).replace("{b: 1.0}", "{b: {pace: 1.0, quality: 0.9}}")
TIRED = "fatigue: {model: lffrm, tires_half_in: 1 h, recovers_half_in: 10 min}, "


@pytest.mark.parametrize(("fatigue", "share"), [(TIRED, 0.4), (TIRED, 0), (TIRED, 1)])
def test_the_tired_leave_the_same_defects_as_in_the_reference(fatigue, share):
    log = of_both(planned(INSPECTED, f"human: {{{fatigue}errors: {{at_full_fatigue: {share}}}}}"))
    assert np.count_nonzero(log["kind"] == REWORK) > 3
    assert np.count_nonzero((log["kind"] == FINISH) & (log["cause"] == BAD)) > 3
