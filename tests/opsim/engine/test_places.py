"""Blocking before service and buffers behind: by hand arithmetic."""

import pytest
from made.shops import HEAD, ran, spans

LINE = """
tasks: {quick: {fixed: 10 s, automatic: true}, slow: {fixed: 30 s, automatic: true}}
stations: {s1: {at: hall, tasks: [quick]MORE}, s2: {at: hall, tasks: [slow], buffer: 0}}
products: {a: {route: [s1, s2]}}
"""


def test_after_service_a_job_waits_on_its_server(tmp_path):
    log = ran(tmp_path, LINE.replace("MORE", ""), "0,a 0,a 0,a")
    assert spans(log, "work", "s1") == [("a", 0, 10), ("a", 10, 20), ("a", 40, 50)]
    assert spans(log, "blocked", "s1") == [("a", 20, 40), ("a", 50, 70)]


@pytest.mark.parametrize("flow", ["", "flow: {blocking: before}\n"])
def test_before_service_a_job_waits_with_its_work_undone(tmp_path, flow):
    log = ran(tmp_path, LINE.replace("MORE", "" if flow else ", blocking: before") + flow, "0,a 0,a 0,a")
    assert spans(log, "work", "s1") == [("a", 0, 10), ("a", 40, 50), ("a", 80, 90)]
    assert spans(log, "held", "s1", "place") == [("a", 10, 40), ("a", 50, 80)]
    assert spans(log, "blocked") == []
    assert spans(log, "work", "s2") == [("a", 10, 40), ("a", 50, 80), ("a", 90, 120)]


def test_a_place_is_kept_from_others(tmp_path):
    """a has the only place at s2 from 0 s, b comes to its gate at 5 s and gets in after it."""
    text = LINE.replace("MORE", ", blocking: before").replace("products: {", "products: {b: {route: [s2]}, ")
    log = ran(tmp_path, text, "0,a 5,b")
    assert spans(log, "work", "s2") == [("a", 10, 40), ("b", 40, 70)]


def test_the_way_that_is_drawn_is_the_same_before_and_after(tmp_path):
    text = """
tasks: {cut: {fixed: 1 s, automatic: true}}
stations: {s0: {at: hall, tasks: [cut]MORE}, s1: {at: hall, tasks: [cut]}, s2: {at: hall, tasks: [cut]}}
products: {a: {routing: {start: s0, s0: {s1: 0.4, s2: 0.3, out: 0.3}, s1: out, s2: s0}}}
"""
    orders = " ".join(f"{5 * n},a" for n in range(30))
    after, before = (ran(tmp_path, text.replace("MORE", more), orders) for more in ("", ", blocking: before"))
    assert spans(after, "work", "s2") == spans(before, "work", "s2") != []
    assert spans(after, "work", "s0") == spans(before, "work", "s0")


def test_finished_jobs_clear_the_server_where_there_is_room_behind(tmp_path):
    log = ran(tmp_path, LINE.replace("MORE", ", buffer_after: 1"), "0,a 0,a 0,a 0,a")
    assert spans(log, "work", "s1") == [("a", 0, 10), ("a", 10, 20), ("a", 20, 30), ("a", 40, 50)]
    assert spans(log, "queue", "s1", "after") == [("a", 20, 40), ("a", 40, 70), ("a", 70, 100)]
    assert spans(log, "blocked", "s1") == [("a", 30, 40), ("a", 50, 70)]
    assert [start for _, start, _ in spans(log, "work", "s2")] == [10, 40, 70, 100]


def test_the_buffer_behind_is_not_that_in_front(tmp_path):
    text = LINE.replace("MORE", ", buffer: 1, buffer_after: 2") + ""
    log = ran(tmp_path, text, " ".join(["0,a"] * 7))
    inside = [spans(log, "queue", "s1", ""), spans(log, "held", cause="gate")]
    assert inside[0] == [("a", 0, 10), ("a", 10, 20), ("a", 20, 30), ("a", 30, 40), ("a", 40, 70), ("a", 70, 100)]
    assert inside[1] == [("a", 0, 10), ("a", 0, 20), ("a", 0, 30), ("a", 0, 40), ("a", 0, 70)]


def test_who_did_the_work_is_free_once_the_job_is_put_away(tmp_path):
    text = LINE.replace("quick: {fixed: 10 s, automatic: true}", "quick: {fixed: 10 s}").replace(
        "MORE", ", buffer_after: 1"
    )
    text += "workers: {eve: {skills: {s1: 1}}}\nallocation: {when_blocked: held}\n"
    log = ran(tmp_path, text, "0,a 0,a 0,a 0,a")
    assert spans(log, "work", "s1") == [("a", 0, 10), ("a", 10, 20), ("a", 20, 30), ("a", 40, 50)]
    assert spans(log, "wait", "s1", "blocked") == [("a", 30, 40), ("a", 50, 70)]


def test_who_carries_a_job_waits_with_it_behind(tmp_path):
    text = LINE.replace("quick: {fixed: 10 s, automatic: true}", "quick: {fixed: 10 s}").replace(
        "MORE", ", buffer_after: 1"
    )
    text = text.replace("route: [s1, s2]", "route: [s1, s2], carried: true")
    log = ran(tmp_path, text + "workers: {eve: {skills: {s1: 1}}, ida: {skills: {s1: 1}}}\n", "0,a 0,a 0,a 0,a")
    assert spans(log, "work", "s1") == [("a", 0, 10), ("a", 10, 20), ("a", 20, 30), ("a", 40, 50)]
    assert spans(log, "queue", "s1", "after") == [("a", 20, 40), ("a", 40, 70), ("a", 70, 100)]


def test_a_job_that_comes_back_to_its_station_from_behind_needs_room_in_front(tmp_path):
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [cut], buffer: 0, buffer_after: 1}}
products: {a: {route: [s1, s1]}}
"""
    log = ran(tmp_path, text, "0,a 0,a")
    assert len(spans(log, "finish")) == 2


@pytest.mark.parametrize("more", ["", ", buffer_after: 1"])
def test_a_job_that_stays_for_its_next_operation_keeps_its_own_place(tmp_path, more):
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [cut], buffer: 1, blocking: beforeMORE}}
products: {a: {route: [s1, s1]}}
""".replace("MORE", more)
    log = ran(tmp_path, text, "0,a 0,a 0,a")
    assert [end for _, _, end in spans(log, "finish")] == [30, 40, 60]


def test_a_job_that_comes_back_to_its_own_station_through_cards_keeps_the_one_place_it_has(tmp_path):
    text = """
tasks: {cut: {fixed: 5 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], blocking: before, buffer: BUFFER}}
cards: {loop: {n: 5}}
products: {a: {route: [saw, saw]}}
"""
    for buffer in ("0", "1"):
        log = ran(tmp_path, text.replace("BUFFER", buffer), "0,a 20,a 40,a")
        assert spans(log, "work") == [("a", start, start + 5) for start in (0, 5, 20, 25, 40, 45)]


def test_a_place_and_its_card_are_given_back_when_the_job_goes_back_for_rework(tmp_path):
    text = """
tasks: {cut: {fixed: 5 s, automatic: true}}
stations:
  saw: {at: hall, tasks: [cut], blocking: before, yield: 0.001, inspect: {then: {rework: saw}, most: 1}}
  pack: {at: hall, tasks: [cut]}
cards: {loop: {n: 1, from: pack}}
products: {a: {route: [saw, pack]}}
"""
    log = ran(tmp_path, text, "0,a 0,a")
    assert spans(log, "work", "saw") == [("a", 0, 5), ("a", 5, 10), ("a", 10, 15), ("a", 15, 20)]
    assert len(spans(log, "scrap")) == 2


def test_a_job_that_waits_for_a_vehicle_on_its_server_is_put_away_when_there_is_room_behind(tmp_path):
    head = HEAD.replace("{hall: [0 m, 0 m]}", "{hall: [0 m, 0 m], far: [30 m, 0 m]}")
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], buffer_after: 1}, packer: {at: far, tasks: [cut]}}
products: {a: {route: [saw, packer]}}
transporters: {fork: {n: 1, at: far, speed: 1 m/s, legs: [[saw, packer]]}}
"""
    log = ran(tmp_path, text, "0,a 0,a 0,a", head)
    assert spans(log, "work", "saw") == [("a", 0, 10), ("a", 10, 20), ("a", 40, 50)]
    assert spans(log, "held", "saw", "pickup") == [("a", 20, 40), ("a", 50, 100)]
