from opsim.report.sections.exposure_summary import exposure_sentences
from tests.opsim.report.made_exposure import ROWS, by, levels, row


def test_who_where_when_and_which_region_are_said_with_their_intervals():
    said = " ".join(exposure_sentences(ROWS))
    assert (
        "ana is exposed most: 25.0 (24.5 to 25.5) minutes of each hour at RULA 5 or more, 6.0 of them at RULA 7" in said
    )
    assert "ben has least, 15.0 (14.5 to 15.5)." in said
    assert "these tasks take: pick 80 % and pack 20 %." in said
    assert "worst hour is that from 06:00" in said and "best that from 07:00" in said
    assert "What brings people to RULA 5 or more: the trunk (60 %) and the load (40 %)." in said
    assert "What brings them to RULA 7: the trunk (75 %) and the load (25 %)." in said
    assert "at least 20.00 and at most 24.00 minutes" in said and "of an hour of who is there, breaks included" in said


def test_how_much_of_the_work_is_seen_is_said_with_the_bounds():
    known = row("posture_measured_share", "", "", 0.56, 0.01) | {"unit": "share"}
    said = exposure_sentences([*ROWS, known])[-1]
    assert "24.00 minutes of an hour, of the 56 % of the work whose posture is known" in said
    assert "is known" not in exposure_sentences([*ROWS, known | {"mean": 1.0}])[-1]


def test_how_evenly_three_workers_share_it_is_said():
    gini = row("exposure_gini", "", "rula_from_5", 0.34, 0.05) | {"unit": "1"}
    rows = [*ROWS, *levels("cy", 1.0, 16.0, 17.0), gini]
    assert "all alike, near 1: one has it all): 0.34 (0.29 to 0.39)." in " ".join(exposure_sentences(rows))
    assert "Gini" not in " ".join(exposure_sentences([*ROWS, gini]))


def test_what_intervals_do_not_tell_apart_is_not_said_to_differ():
    rows = [*levels("", 0, 10, 10, 3), *levels("ana", 0, 11, 11, 3), *levels("ben", 0, 9, 9, 3)]
    rows += [*by("exposure_by_hour", "06:00", 0, 11, 11, 3), *by("exposure_by_hour", "07:00", 0, 9, 9, 3)]
    rows += [*by("exposure_by_station", "a", 0, 6, 6, 3), *by("exposure_by_station", "b", 0, 4, 4, 3)]
    said = " ".join(exposure_sentences(rows))
    assert "not told apart" in said and "no hour is told apart" in said and "station" not in said


def test_nothing_is_said_where_nobody_asked_and_that_nobody_was_seen_where_nobody_was():
    assert exposure_sentences([]) == []
    assert exposure_sentences([*levels("", 0, 0, 0), *levels("ana", 0, 0, 0)]) == ["Nobody was seen at RULA 5 or more."]
    only_maybe = exposure_sentences([*levels("", 0, 0, 5), *levels("ana", 0, 0, 5)])
    assert only_maybe[0] == "Nobody is surely at RULA 5 or more." and "at most" in only_maybe[-1]
