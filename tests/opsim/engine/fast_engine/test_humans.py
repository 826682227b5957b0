"""Human effects together, on both engines: in their order, neutral and not, on floors of many blocks."""

import pytest
from human_plans import NEUTRAL, shipped
from twins import of_both

ALL = """
human:
  ACTS
  learning: {model: plateau, rate: 0.8, measured_at: 7}
  forgetting: {model: lfcm, forgotten_in: 30 d, least_pause: 2 min}
  state_pace: {model: schultz, faster: 0.2, slower: 0.1}
  circadian: {amplitude: 0.1, peak: '03:00'}
  fatigue: {model: lffrm, tires_half_in: 20 min, recovers_half_in: 5 min}
  rest: {above: 0.5, until: 0.2}
  errors: {at_full_fatigue: 0.3}
"""


@pytest.mark.parametrize(("name", "hours"), [("relief_worker", 3.0), ("paced_line", 1.5), ("solder_rework", 2.0)])
def test_all_effects_at_once_are_those_of_the_reference(name, hours):
    for acts_on in ("posture", "time"):
        of_both(shipped(name, hours, ALL.replace("ACTS", f"acts_on: {acts_on}")))


def test_neutral_effects_change_nothing_here_either():
    neutral, without = (of_both(shipped("serial_line", 2.0, human)) for human in (NEUTRAL, ""))
    assert neutral["end_s"].tolist() == without["end_s"].tolist()
