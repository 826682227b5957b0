"""Random floors with everything people may do: neutral effects change no bit, and with all effects on every law holds.

So the law of pace finds each time in its draw, the repetitions read from the rows and the shift of the row, whatever
breaks work off, hands it over or lets it wait. Without a pace by the state of the line, the law of fatigue also finds
each shift in the worker's day.
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
from made_troubles import troubled

from opsim.engine.floor import run_plan
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
NO_STATE_PACE = ALL.replace("  state_pace: {model: schultz, faster: 0.3, slower: 0.2}\n", "")


def made(seed, human="", troubles=False):
    """The text of a floor with shifts, breaks and up to seven other blocks; with what breaks work off, or without."""
    pick = Lots(seed)
    mine = pick.shuffled([name for name in (*PEOPLE, *CREWS) if name not in ALWAYS])[: pick.whole(1, 4)]
    values = people_floor_with(pick, [*ALWAYS, *mine, *pick.shuffled(list(BLOCKS))[: pick.whole(0, 3)]])
    if troubles:
        values = troubled(pick, values)
    return text_of(values | yaml.safe_load(human or "{}"))


def check(seed, human=ALL, troubles=False):
    """How many shifts of times the floor saw with all effects on."""
    plain, neutral = (plan_of(made(seed, effects, troubles)) for effects in ("", NEUTRAL))
    assert differ(run_plan(plain), run_plan(neutral)) == []
    plan = plan_of(made(seed, human, troubles))
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    return np.unique(log["pace_shift"][log["kind"] == WORK]).size


@pytest.mark.parametrize("seed", range(4))
def test_neutral_effects_change_no_bit_and_others_keep_every_law(seed):
    check(seed)


@pytest.mark.slow
def test_neutral_effects_change_no_bit_and_others_keep_every_law_on_many_floors():
    assert sum(check(seed) > 2 for seed in range(4, 34)) > 20


@pytest.mark.parametrize("human", [ALL, NO_STATE_PACE], ids=["all", "no_state_pace"])
@pytest.mark.parametrize("seed", [13, 14, 64])
def test_they_keep_every_law_where_work_is_broken_off_as_it_begins(seed, human):
    check(seed, human, troubles=True)


@pytest.mark.slow
def test_they_keep_every_law_where_work_is_broken_off_as_it_begins_on_many_floors():
    found = [check(seed, human, troubles=True) > 2 for seed in range(100, 120) for human in (ALL, NO_STATE_PACE)]
    assert sum(found) > 25
