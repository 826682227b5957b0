"""Targets as they are written."""

import pytest

from opsim.kpi.targets import read_target


@pytest.mark.parametrize(("text", "kpi", "bound", "at_least"), [
    ("480 a day", "", 480, True),
    ("12.5 jobs per day", "", 12.5, True),
    ("throughput_per_h >= 60", "throughput_per_h", 60, True),
    ("time_in_system_s<=3600", "time_in_system_s", 3600, False),
])  # fmt: skip
def test_a_target_is_read(text, kpi, bound, at_least):
    target = read_target(text)
    assert (target.asked.kpi, target.bound, target.at_least) == (kpi, bound, at_least)
    assert read_target(target.words) == target


def test_a_target_of_one_worker_names_him():
    target = read_target("rula_from_5_min_per_h/ana/at_most <= 10")
    assert (target.asked.subject, target.asked.part) == ("ana", "at_most")


@pytest.mark.parametrize(("text", "words"), [
    ("throughput_per_hour >= 60", "did you mean 'throughput_per_h'"),
    ("480", "480 a day"),
    ("throughput_per_h > 60", "throughput_per_h >= 60"),
    ("throughput_per_h >= many", "no target"),
    ("", "no target"),
])  # fmt: skip
def test_what_is_no_target_is_answered_with_how_one_is_written(text, words):
    with pytest.raises(ValueError, match=words):
        read_target(text)
