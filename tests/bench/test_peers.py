"""opsim and the simulators beside it give the exact answer to each model: only then are their speeds worth comparing.

The table is ``make bench-peers``, where the others are installed.
"""

import pytest
from bench.peers import compare

RUNNERS = compare.runners()


@pytest.mark.parametrize("runner", RUNNERS, ids=lambda runner: f"{runner.label}: {runner.variant}")
def test_every_model_answers_exactly(runner):
    found, wanted = compare.exact(runner)
    assert compare.agree(found, wanted), f"found {found}, expected {wanted}"


def test_an_answer_one_job_off_is_refused():
    _, (finished, answer) = compare.exact(RUNNERS[0])
    assert not compare.agree((finished + 1, answer), (finished, answer))
    assert not compare.agree((finished, answer * (1 + 1e-6)), (finished, answer))
