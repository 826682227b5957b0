from math import inf

import pytest

from opsim.human.catalogue import Parameter, as_written, entry, name_written, parameters_written

TIME = Parameter("pause_s", "a pause", "s", 60.0)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(31_536_000.0, "365 d"), (86_400.0, "1 d"), (14_400.0, "4 h"), (90.0, "90 s"), (5400.0, "90 min"), (inf, "never")],
)
def test_times_are_written_as_in_a_scenario(seconds, text):
    assert as_written(TIME, seconds) == text


def test_a_parameter_is_named_without_its_unit():
    assert name_written(TIME) == "pause"


def test_a_peak_is_a_time_of_the_day():
    assert parameters_written(entry("circadian")) == "amplitude 0.05, peak 16:48"
