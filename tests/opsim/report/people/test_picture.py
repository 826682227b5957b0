import numpy as np
import pytest

from opsim.report.motion import people as picture
from tests.made.people import NONE, found


@pytest.fixture
def axes(monkeypatch):
    """The two axes of the picture of some tasks, before they become text."""
    monkeypatch.setattr(picture, "svg", lambda drawn: drawn.axes)
    return picture.picture


def dots(of):
    """(n, 2) of each task's dots."""
    return [np.asarray(cloud.get_offsets()) for cloud in of.collections]


def test_each_repetition_is_a_dot_of_pooled_against_own_scores(axes):
    _, right = axes([found(), found("lift")])
    for cloud in dots(right):
        assert np.allclose(cloud[:3], [[1.0, 0.3], [1.0, 0.5], [1.0, 1.8]]) and np.isnan(cloud[3, 1])


def test_the_diagonal_is_drawn_as_far_as_the_scores_go(axes):
    (line,) = axes([found()])[1].lines
    assert np.array_equal(line.get_xdata(), line.get_ydata()) and line.get_xdata().tolist() == [0.0, 1.0]


def test_each_quantity_of_a_task_is_an_interval_about_a_dot(axes):
    left, _ = axes([found(), found("lift")])
    assert [label.get_text() for label in left.get_yticklabels()] == ["log duration", "pace score 1"]
    drawn = [line for line in left.lines if line.get_xdata()[0] == -0.1]
    assert [line.get_xdata().tolist() for line in drawn] == [[-0.1, 0.9]] * 2
    heights = [line.get_ydata()[0] for line in drawn]
    assert heights[0] < 0 < heights[1] and [cloud[0, 0] for cloud in dots(left)[::2]] == [0.5, 0.5]


def test_many_tasks_all_look_different_and_their_names_are_no_formulas(axes):
    _, right = axes([found(f"$task {i}$") for i in range(9)])
    looks = {(tuple(c.get_facecolor()[0]), c.get_paths()[0].vertices.tobytes()) for c in right.collections}
    (legend,) = right.figure.legends
    assert len(looks) == 9 and [text.get_text() for text in legend.get_texts()] == [f"$task {i}$" for i in range(9)]
    assert not any(text.get_parse_math() for text in legend.get_texts())


def test_a_task_in_which_nothing_could_be_judged_draws_no_dots(axes):
    assert np.all(np.isnan(dots(axes([found(known=[NONE] * 4)])[1])[0][:, 1]))
