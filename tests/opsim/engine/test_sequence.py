"""Which waiting job is next, and which station it goes to: by hand arithmetic on orders that come at given times."""

import pytest
from made_shops import begun, ran, spans

ONE = """
tasks: {long: {fixed: 20 s, automatic: true}, short: {fixed: 5 s, automatic: true}, cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], dispatch: RULE}, l: {at: hall, tasks: [long]}, s: {at: hall, tasks: [short]}}
products: {a: {route: [saw, l]}, b: {route: [saw, l, s], due: 70 s}, c: {route: [saw], due: 90 s}}
"""


@pytest.mark.parametrize(("rule", "order"), [
    ("fifo", "aabc"),
    ("edd", "abca"),  # due: b 70 s, c 90 s, a never
    ("critical_ratio", "abca"),  # at 10 s: b (70 + 2 - 10) / 35, c (90 + 3 - 10) / 10, a infinite
    ("downstream_first", "acab"),  # operations left: c 1, a 2, b 3
])  # fmt: skip
def test_the_rule_says_which_waiting_job_is_next(tmp_path, rule, order):
    log = ran(tmp_path, ONE.replace("RULE", rule), "0,a 1,a 2,b 3,c")
    assert begun(log, "saw") == order
    assert [start for _, start, _ in spans(log, "work", "saw")] == [0, 10, 20, 30]


def test_spt_takes_the_shortest_operation(tmp_path):
    """Lots of one, five and two units: 2 s each."""
    text = """
tasks: {cut: {fixed: 2 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut]}}
products: {a: {route: [saw]}, b: {route: [saw], lot: 5}, c: {route: [saw], lot: 2}}
flow: {dispatch: spt}
"""
    assert begun(ran(tmp_path, text, "0,b 1,b 2,c 3,a"), "saw")[::1].replace("bbbbb", "B").replace("cc", "C") == "BaCB"


def test_a_job_of_higher_priority_goes_before_any_rule_and_does_not_interrupt(tmp_path):
    text = ONE.replace("RULE", "edd").replace("a: {", "a: {priority: 3, ").replace("c: {", "c: {priority: 3, ")
    log = ran(tmp_path, text, "0,b 1,b 2,a 3,c")
    assert begun(log, "saw") == "bcab"
    assert spans(log, "work", "saw")[0] == ("b", 0, 10)


def test_priority_of_an_order_comes_from_its_schedule(tmp_path):
    log = ran(tmp_path, ONE.replace("RULE", "fifo"), "time,product,priority 0,a,0 1,b,0 2,c,7 3,a,9")
    assert begun(log, "saw") == "aacb"


def test_jobs_of_higher_priority_come_in_first_where_the_buffer_is_full(tmp_path):
    text = (
        ONE.replace("RULE", "fifo")
        .replace("tasks: [cut]", "tasks: [cut], buffer: 1")
        .replace("c: {", "c: {priority: 1, ")
    )
    assert begun(ran(tmp_path, text, "0,a 1,a 2,b 3,c"), "saw") == "aacb"


FORK = """
tasks: {quick: {fixed: 10 s, automatic: true}, slow: {fixed: 40 s, automatic: true}}
stations: {m1: {at: hall, tasks: [slow]}, m2: {at: hall, tasks: [quick]}, m3: {at: hall, tasks: [quick], servers: 2}}
products: {a: {route: [[m2, m1, m3]]}}
flow: {routing: RULE}
"""


@pytest.mark.parametrize(("rule", "stations"), [
    ("shortest_queue", "m1 m2 m3 m3 m1"),  # jobs per server: 0 0 0, 1 0 0, 1 1 0, 1 1 1/2, 1 1 1
    ("in_order", "m2 m2 m2 m2 m2"),
    ("first_free", "m2 m1 m3 m3 m2"),
    ("least_loaded", "m3 m2 m3 m3 m2"),  # (n + 1) mean / servers: 40 10 5, 40 10 10, 40 20 10, 40 20 15, 40 20 20
])  # fmt: skip
def test_the_rule_says_which_station_a_job_goes_to(tmp_path, rule, stations):
    log = ran(tmp_path, FORK.replace("RULE", rule), "0,a 1,a 2,a 3,a 4,a")
    came = {}
    for i in range(len(log)):
        if log["station"][i] >= 0 and log["job"][i] >= 0:
            came.setdefault(int(log["job"][i]), log.names["station"][log["station"][i]])
    assert " ".join(came[job] for job in sorted(came)) == stations
