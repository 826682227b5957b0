import pytest

from opsim.report.plot.plotly import STATE_COLOURS as STATES
from opsim.report.plot.plotly import in_order, label, legend, states, wrong_sums
from tests.made_result import SCRIPT
from tests.made_result import states as state_rows


def test_the_bars_of_each_subject_sum_to_one():
    rows = state_rows("worker_states", "ana", work=0.6, wait=0.4) + state_rows(
        "worker_states", "ben", walk=0.3, work=0.7
    )
    figure = states(rows)
    assert [sum(bar["x"][i] for bar in figure["data"]) for i in (0, 1)] == pytest.approx([1.0, 1.0])
    assert wrong_sums(rows) == []


def test_shares_that_do_not_sum_to_one_are_named():
    assert wrong_sums(state_rows("worker_states", "ana", work=0.6, wait=0.3)) == [("ana", pytest.approx(0.9))]


def test_states_that_take_no_time_have_no_legend():
    rows = state_rows("station_states", "weld", work=0.9, blocked=0.0, starved=0.1)
    assert [words for _, words in legend(rows)] == ["work", "no job"]


def test_an_unknown_state_is_drawn_last():
    assert in_order(["juggling", "wait", "work"]) == ["work", "wait", "juggling"]


def test_no_two_states_have_one_colour():
    colours = [fill for fill, _ in STATES.values()]
    assert len(set(colours)) == len(colours)


def test_labels_cannot_be_read_as_markup():
    assert label(SCRIPT[:15]) == "&lt;script&gt;window."
    assert "<" not in label(SCRIPT) and label("x" * 40).endswith("…")
