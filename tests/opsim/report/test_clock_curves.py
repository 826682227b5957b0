from itertools import pairwise

import numpy as np

from opsim.report.sections.learning_fatigue import Curve, curves_figure, curves_legend, thinned, ticks_s


def test_thinning_keeps_the_ends_and_the_peak():
    at_s, value = np.arange(10_000.0), np.sin(np.arange(10_000.0))
    value[4321] = 5.0
    some_s, some = thinned(at_s, value)
    assert some_s.size <= 700 and some.max() == 5.0 and (some_s[0], some_s[-1]) == (0.0, 9999.0)
    assert thinned(at_s[:5], value[:5])[0].size == 5


def test_ticks_stand_at_round_times_of_the_clock():
    assert ticks_s("Mon 06:10", 0.0, 4 * 3600.0) == [3000.0, 6600.0, 10200.0, 13800.0]
    words = curves_figure([Curve("ana", np.array([0.0, 3 * 86400.0]), np.array([0.0, 0.5]))], "Mon 06:00", "%")
    assert "Tue 00:00" in words["layout"]["xaxis"]["ticktext"]


def test_neighbouring_curves_differ_in_colour_and_in_dashes():
    looks = curves_legend([Curve(name, np.zeros(1), np.zeros(1)) for name in "abcdefgh"])
    assert len({colour for colour, *_ in looks}) == 8 and all(a[1] != b[1] for a, b in pairwise(looks[:3]))
