"""The shipped eight-station cell: its layout is a random one of the middle, and the study finds a better one.

The whole of it, with all 200 random layouts simulated: ``PYTHONPATH=tests python -m study_evidence.layout``.
"""

import numpy as np
import pytest
from study_evidence.layout import EACH, FILE, asked_for, drawn, shipped

from opsim.study.jobs import Answers, Source
from opsim.study.layout.evaluate import BEST, WALKED
from opsim.study.layout.study import study_layout

NUMBER = 67
"""Which of the random layouts is shipped."""


@pytest.mark.slow
def test_the_shipped_layout_is_a_random_one_and_about_half_of_others_walk_less():
    layouts = drawn(range(12), each=EACH, processes=1)
    base = drawn([NUMBER], each=EACH, processes=1)[0]
    less = np.mean([one.walked_m_per_h < base.walked_m_per_h for one in layouts])
    assert base.at == shipped() and 0.2 <= less <= 0.8


@pytest.mark.slow
def test_the_proposal_for_the_shipped_cell_is_better_in_walking_and_throughput_on_fresh_numbers():
    asked = asked_for({"proposals": 1, "replications": 5, "exposure": "walked_m"})  # no postures: a third of the time
    found = study_layout(asked, Answers(Source(FILE, asked.kept), processes=1))
    assert found.taken is not None and found.taken.proposed
    assert found.fresh[WALKED].difference.high < 0 < found.fresh[BEST].difference.low
    assert found.fresh[WALKED].relative[0] < -0.25
