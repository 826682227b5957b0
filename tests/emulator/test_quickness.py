from dataclasses import replace

import pytest

from emulator.quickness import ROOM, emulated_m_per_s, no_faster, recorded_m_per_s
from tests.emulator.fitted import made


@pytest.fixture(scope="module")
def emulator():
    return made("pick")[2]


def test_the_fastest_joint_is_the_fastest_of_all_recordings():
    motions = made("pick")[0]
    each = [recorded_m_per_s(motions.subset([i])) for i in range(len(motions))]
    assert recorded_m_per_s(motions) == max(each)
    twice = replace(motions, motions=tuple(replace(m, time_s=2 * m.time_s) for m in motions.motions))
    assert recorded_m_per_s(twice) == pytest.approx(max(each) / 2)


def test_emulated_recordings_are_about_as_fast_as_they_were(emulator):
    scores = emulator.workforce.smoothed.scores
    assert emulated_m_per_s(emulator, scores).max() == pytest.approx(emulator.report.fastest_m_per_s, rel=0.1)


def test_who_is_no_faster_than_that_is_left_as_he_is(emulator):
    mean = emulator.workforce.between.mean
    assert no_faster(emulator, mean, emulator.workforce.between) is mean


def test_who_is_too_fast_keeps_his_time_and_loses_his_haste(emulator):
    """Ten times as far from the mean as anybody: drawn in until nothing is more than a quarter faster than recorded."""
    crew, at = emulator.workforce, emulator.scale.block("duration").start
    limit = ROOM * emulator.report.fastest_m_per_s
    seen = 0
    for name in range(len(crew.names)):
        wild = crew.between.mean + 10 * (crew.effects[name] - crew.between.mean)
        wild[at] = crew.between.mean[at]
        if emulated_m_per_s(emulator, wild[None])[0] <= limit:
            continue
        tame = no_faster(emulator, wild, crew.between)
        assert tame[at] == wild[at]
        assert emulated_m_per_s(emulator, tame[None])[0] <= limit
        seen += 1
    assert seen > 0


def test_a_library_that_does_not_say_how_fast_recordings_were_changes_nobody(emulator):
    silent = replace(emulator, report=replace(emulator.report, fastest_m_per_s=float("nan")))
    wild = 50 * silent.workforce.effects[0]
    assert no_faster(silent, wild, silent.workforce.between) is wild
