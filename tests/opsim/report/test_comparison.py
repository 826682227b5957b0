import math
import re

import numpy as np

from opsim.report.comparison import comparison_cells, comparison_html
from opsim.report.plot.svg_chart import intervals_svg
from opsim.study.compare import Comparison, Difference, paired
from opsim.study.intervals import Interval

HARM = '<script>alert("x")</script>'


def difference(mean=1.0, half=0.25, sd=0.5, variant="near", p=0.001):
    key = ("throughput_per_h", HARM, "", "1/h")
    return Difference(variant, key, 20.0, 20.0 + mean, Interval(mean, half, sd, 10), p, p, 12.345)


def test_a_difference_shows_as_many_digits_as_its_interval_supports():
    cells = comparison_cells(difference())
    assert cells["difference"] == "1.00 ± 0.25" and cells["base"] == "20.00" and cells["pairing"] == "12.3"
    assert cells["relative"] == "5.0 %" and cells["verdict"] == "higher"


def test_identical_is_said_and_no_nan_is_shown():
    cells = comparison_cells(difference(0.0, 0.0, 0.0, p=1.0))
    assert cells["difference"] == "0" and cells["verdict"] == "identical"
    unknown = comparison_cells(difference(math.nan, math.nan, math.nan, p=math.nan))
    assert "nan" not in "".join({**cells, **unknown}.values())


def test_no_name_becomes_markup():
    page = comparison_html(Comparison("base", 1, 10, (difference(variant=HARM),)), HARM)
    assert "<script>" not in page and "&lt;script&gt;" in page


def test_a_picture_has_a_dot_a_variant_and_a_line_at_zero():
    svg = intervals_svg(
        [("a", -1.0, 0.5, 2.0, "no clear difference"), ("b", math.nan, 3.0, math.nan, "one")], "per hour"
    )
    assert svg.count("<circle") == 2 and svg.count('stroke-width="3"') == 1 and svg.count('stroke-width="1.5"') == 1
    x = [float(at) for at in re.findall(r'<circle cx="([\d.]+)"', svg)]
    assert x[0] < x[1]


def test_a_picture_of_nothing_but_zero_is_still_a_picture():
    assert "nan" not in intervals_svg([("same", 0.0, 0.0, 0.0, "identical")], "min")


def test_a_difference_far_below_what_it_is_of_shows_no_digits_of_its_own():
    """Rest of 2.756183 and 2.756181 minutes: a difference of a millionth of it is 0 to whoever reads."""
    base = np.array([2.756183, 2.756184, 2.756182])
    interval, p, ratio = paired(base - [2e-6, 1e-6, 3e-6], base)
    cells = comparison_cells(Difference("b", ("x", "", "", "min/h"), 2.756183, 2.756181, interval, p, p, ratio))
    assert (cells["base"], cells["difference"], cells["relative"]) == ("2.7562", "0.0000 ± 0.0001", "0.00 %")
