"""Random floors with everything people may do: neutral effects change no bit, and with all effects on every law holds.

So the law of pace finds each time in its draw, the repetitions read from the rows and the shift of the row, whatever
breaks work off, hands it over or lets it wait.
"""

import numpy as np
import pytest
import yaml
from checked_floors import differ, plan_of
from choices import Lots
from human_plans import NEUTRAL
from made_blocks import BLOCKS
from made_crews import CREWS
from made_floors import text_of
from made_people_blocks import ALWAYS, PEOPLE, people_floor_with

from opsim.engine.simpy_engine import run_plan
from opsim.laws import CHECKS, audit
from opsim.log import WORK

ALL = """
human:
  learning: {model: dual_phase, measured_at: 30}
  forgetting: {model: lfcm, forgotten_in: 2 d, least_pause: 1 min}
  state_pace: {model: schultz, faster: 0.3, slower: 0.2}
  circadian: {amplitude: 0.2}
  fatigue: {model: lffrm, tires_half_in: 30 min}
  rest: {above: 0.5, until: 0.3}
  errors: {at_full_fatigue: 0.2}
"""


def made(seed, human=""):
    """The text of a floor with shifts, breaks and up to seven other blocks."""
    pick = Lots(seed)
    mine = pick.shuffled([name for name in (*PEOPLE, *CREWS) if name not in ALWAYS])[: pick.whole(1, 4)]
    values = people_floor_with(pick, [*ALWAYS, *mine, *pick.shuffled(list(BLOCKS))[: pick.whole(0, 3)]])
    return text_of(values | yaml.safe_load(human or "{}"))


def check(seed):
    """How many shifts of times the floor saw with all effects on."""
    assert differ(run_plan(plan_of(made(seed))), run_plan(plan_of(made(seed, NEUTRAL)))) == []
    plan = plan_of(made(seed, ALL))
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    return np.unique(log["pace_shift"][log["kind"] == WORK]).size


@pytest.mark.parametrize("seed", range(4))
def test_neutral_effects_change_no_bit_and_others_keep_every_law(seed):
    check(seed)


@pytest.mark.slow
def test_neutral_effects_change_no_bit_and_others_keep_every_law_on_many_floors():
    assert sum(check(seed) > 2 for seed in range(4, 34)) > 20
