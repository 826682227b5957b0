"""A store that is kept filled: pieces are begun for those that were taken, wanted or scrapped.

Which waiting job is next, and which station it goes to: by hand arithmetic on orders that come at given times.

Set-ups: each server is set up for what comes, by hand arithmetic.
"""

import pytest
from made.shops import HEAD, begun, ran, spans
from plans import plan

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import CREATE, FINISH, SCRAP, WORK

STOCK = """
opsim: 1
name: stock
run: {horizon: 100 s}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {make: {fixed: 3 s, automatic: true}}
stations: {s1: {at: hall, tasks: [make]}, out: {at: hall, tasks: [], servers: 9}}
stores: {rack: {at: hall, initial: 2}}
products: {piece: {route: [s1, rack]}, order: {route: [out], parts: {out: {piece: 1}}}}
"""
ORDERS = "orders: {kind: renewal, every: {fixed: 20 s}, products: [order]}"


def run(text):
    made = plan(text)
    log = run_plan(made)
    audit(log, made)
    return log


@pytest.mark.parametrize(("level", "starts"), [
    (2, [20, 40, 60, 80]),
    (3, [0, 20, 40, 60, 80]),
    (0, [60, 80]),  # two orders are met from what lies there
])  # fmt: skip
def test_a_base_stock_makes_a_piece_whenever_stock_and_what_is_on_the_way_are_below_its_level(level, starts):
    refill = f"refill: {{kind: base_stock, store: rack, level: {level}}}"
    log = run(f"{STOCK}sources: {{{ORDERS}, {refill}}}\n")
    assert log.of(WORK)["start_s"].tolist() == starts


def test_a_base_stock_follows_demand_that_it_cannot_meet_at_once():
    """Five orders at once on a stock of two: five pieces are begun at once, one for each order."""
    burst = ORDERS.replace("every: {fixed: 20 s}", "every: {fixed: 60 s}, at_once: 5")
    log = run(f"{STOCK}sources: {{{burst}, refill: {{kind: base_stock, store: rack, level: 2}}}}\n")
    created = log.where((log["kind"] == CREATE) & (log["product"] == 1) & (log["end_s"] > 0))
    assert created["end_s"].tolist() == [60.0] * 5
    assert log.of(FINISH)["end_s"].tolist() == [60.0, 60.0, 63.0, 66.0, 69.0]


def test_scrap_on_the_way_is_made_again_by_a_base_stock():
    text = STOCK.replace("s1: {at: hall, tasks: [make]}", "s1: {at: hall, tasks: [make], scrap: 0.6}")
    log = run(f"{text}sources: {{{ORDERS}, refill: {{kind: base_stock, store: rack, level: 3}}}}\n")
    scrapped, created = log.of(SCRAP)["end_s"], log.where((log["kind"] == CREATE) & (log["product"] == 1))
    assert scrapped.size >= 5
    assert set(scrapped) <= set(created["end_s"])


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


SAW = """
tasks: {cut: {fixed: 10 s, automatic: true}, change: {fixed: 4 s}, wash: {fixed: 2 s, repeat: 3, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], setup: SETUP}}
products: {a: {family: x, route: [saw]}, b: {family: x, route: [saw]}, c: {family: y, route: [saw]}}
"""
WORKER = "workers: {eve: {skills: {saw: 2.0}}}\n"


def sawn(tmp_path, setup, orders, more=""):
    return ran(tmp_path, SAW.replace("SETUP", setup) + more, orders)


def test_a_change_of_product_costs_what_the_matrix_says(tmp_path):
    log = sawn(tmp_path, "{times: {a: {b: 3 s}, b: {a: 5 s}}, otherwise: 7 s, attended: false}", "0,a 0,b 0,a 0,c 0,c")
    assert spans(log, "setup") == [("b", 10, 13), ("a", 23, 28), ("c", 38, 45)]
    assert spans(log, "work") == [("a", 0, 10), ("b", 13, 23), ("a", 28, 38), ("c", 45, 55), ("c", 55, 65)]


def test_the_first_job_finds_the_server_as_it_needs_it_unless_said(tmp_path):
    other = sawn(tmp_path, "{otherwise: 7 s, attended: false, first: a}", "0,b")
    assert spans(other, "setup") == [("b", 0, 7)]
    assert spans(sawn(tmp_path, "{otherwise: 7 s, attended: false}", "0,b"), "setup") == []


def test_families_tell_apart_by_family(tmp_path):
    log = sawn(tmp_path, "{otherwise: 7 s, by: family, attended: false}", "0,a 0,b 0,c")
    assert spans(log, "setup") == [("c", 20, 27)]


def test_the_same_again_costs_only_what_is_said_of_it(tmp_path):
    log = sawn(tmp_path, "{times: {a: {a: 1 s}}, otherwise: 7 s, attended: false}", "0,a 0,a 0,a")
    assert spans(log, "setup") == [("a", 10, 11), ("a", 21, 22)]


def test_no_time_is_no_setup(tmp_path):
    assert spans(sawn(tmp_path, "{otherwise: 0 s, attended: false}", "0,a 0,b"), "setup") == []


def test_a_worker_with_the_skill_sets_up_at_his_own_pace(tmp_path):
    log = sawn(tmp_path, "{otherwise: 6 s}", "0,a 0,b", WORKER)
    assert spans(log, "setup") == [("b", 10, 13)]
    rows = log.where(log["kind"] == log.names["kind"].index("setup"))
    assert rows["worker"].tolist() == [0] and log.names["task"][rows["task"][0]] == "setup: 6 s"


def test_the_worker_is_free_while_the_machine_cuts(tmp_path):
    """Two saws side by side: one man sets both up in turn."""
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations:
  saw1: {at: hall, tasks: [cut], setup: {otherwise: 6 s, first: a}}
  saw2: {at: hall, tasks: [cut], setup: {otherwise: 6 s, first: a}}
products: {a: {route: [saw1]}, b: {route: [saw1]}, c: {route: [saw2]}}
workers: {eve: {skills: {saw1: 1, saw2: 1}}}
"""
    log = ran(tmp_path, text, "0,b 0,c")
    assert spans(log, "setup") == [("b", 0, 6), ("c", 6, 12)]
    assert spans(log, "work") == [("b", 6, 16), ("c", 12, 22)]


def test_a_named_task_sets_up_as_often_as_it_is_repeated(tmp_path):
    log = sawn(tmp_path, "{times: {a: {b: wash}}, otherwise: change}", "0,a 0,b 0,c", WORKER)
    assert spans(log, "setup") == [("b", 10, 12), ("b", 12, 14), ("b", 14, 16), ("c", 26, 28)]


def test_each_server_remembers_what_it_did_and_the_nearest_one_is_taken(tmp_path):
    text = SAW.replace("SETUP", "{otherwise: 7 s, attended: false}").replace("tasks: [cut]", "tasks: [cut], servers: 2")
    log = ran(tmp_path, text, "0,a 0,b 20,b 20,a 40,b")
    assert spans(log, "setup") == []
    log = ran(tmp_path, text, "0,a 0,b 20,c")
    assert spans(log, "setup") == [("c", 20, 27)]


def test_least_setup_stays_with_a_product_as_long_as_there_are_jobs_of_it(tmp_path):
    orders = "0,a 1,b 2,c 3,a 4,b 5,c"
    setup = "{times: {a: {b: 1 s, c: 2 s}}, otherwise: 3 s, attended: false}"
    assert begun(sawn(tmp_path, setup, orders)) == "abcabc"
    assert begun(sawn(tmp_path, setup, orders, "flow: {dispatch: least_setup}\n")) == "aabbcc"


def test_jobs_in_turn_of_equal_setups_come_in_any_order_of_declaration(tmp_path):
    lines = SAW.replace("SETUP", "{otherwise: 7 s, attended: false}").strip().splitlines()
    there, back = ("\n".join(part) for part in (lines, lines[::-1]))
    orders = "0,c 0,b 0,a 0,c 0,a"
    assert spans(ran(tmp_path, there, orders), "work") == spans(ran(tmp_path, back, orders), "work")


@pytest.mark.parametrize("attended", ["true", "false"])
def test_a_breakdown_in_a_setup_only_puts_it_off(tmp_path, attended):
    jam = "breakdowns: {jam: {every: {fixed: 12 s}, repair: {fixed: 5 s}}}"
    text = SAW.replace("SETUP}", f"{{otherwise: 8 s, attended: {attended}}}, {jam}}}")
    log = ran(tmp_path, text + WORKER.replace("2.0", "1.0"), "0,a 0,b")
    assert spans(log, "setup") == [("b", 10, 12), ("b", 17, 23)]


def test_setting_up_is_work_of_the_body_too(tmp_path):
    from opsim.ergonomics.redraw import pieces_in_window
    from opsim.plan import compile_plan
    from opsim.scenario.read import scenarios_in

    text = HEAD + SAW.replace("SETUP", "{otherwise: change}") + WORKER
    log = ran(tmp_path, SAW.replace("SETUP", "{otherwise: change}") + WORKER, "0,a 0,b")
    pieces = pieces_in_window(log, compile_plan(scenarios_in(text.encode(), tmp_path / "shop.yaml")["base"]))
    assert pieces.seconds.tolist() == [2.0] and pieces.k.tolist() == [0]
