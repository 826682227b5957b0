"""Where bars begin and end: the numbers a page's bars have."""

import pytest

from opsim.report.plot.matplotlib_axes import Scale
from opsim.report.plot.matplotlib_marks import draw_bars

matplotlib = pytest.importorskip("matplotlib")


def edges(traces, **layout):
    """(left, width) of each bar that lies, in order."""
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    values = [value for trace in traces for value in trace["x"]]
    draw_bars(axes, traces, Scale({}, values), Scale({}, [y for trace in traces for y in trace["y"]]), layout)
    return [(patch.get_x(), patch.get_width()) for patch in axes.patches], [patch.get_y() for patch in axes.patches]


def lying(x, y=(0, 1), **more):
    return {"type": "bar", "orientation": "h", "x": list(x), "y": list(y), **more}


def test_stacked_bars_begin_where_those_below_end_and_negative_ones_go_the_other_way():
    found, _ = edges([lying([1, 2]), lying([3, -4]), lying([5, -1])], barmode="relative")
    assert found == [(0, 1), (0, 2), (1, 3), (0, -4), (4, 5), (-4, -1)]


def test_bars_over_each_other_all_begin_at_nothing():
    found, _ = edges([lying([1, 2]), lying([3, 4])], barmode="overlay")
    assert [left for left, _ in found] == [0, 0, 0, 0]


def test_bars_beside_each_other_share_the_room():
    _, low = edges([lying([1, 2]), lying([3, 4])], barmode="group", bargap=0.2)
    assert low == pytest.approx([-0.4, 0.6, 0.0, 1.0])


def test_a_bar_with_a_base_begins_there():
    found, _ = edges([lying([1, 2], base=[10, 20])], barmode="overlay")
    assert found == [(10, 1), (20, 2)]


def test_bars_of_time_have_their_length_in_milliseconds():
    from matplotlib.figure import Figure

    axes, clock = Figure().add_subplot(), Scale({"type": "date"}, [])
    draw_bars(axes, [lying([43_200_000], [0], base=[86_400_000])], clock, Scale({}, [0]), {"barmode": "overlay"})
    assert axes.patches[0].get_x() == 1.0 and axes.patches[0].get_width() == 0.5
