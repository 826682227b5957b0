"""Set-ups: each server is set up for what comes, by hand arithmetic."""

import pytest
from made_shops import HEAD, begun, ran, spans

ONE = """
tasks: {cut: {fixed: 10 s, automatic: true}, change: {fixed: 4 s}, wash: {fixed: 2 s, repeat: 3, automatic: true}}
stations: {saw: {at: hall, tasks: [cut], setup: SETUP}}
products: {a: {family: x, route: [saw]}, b: {family: x, route: [saw]}, c: {family: y, route: [saw]}}
"""
WORKER = "workers: {eve: {skills: {saw: 2.0}}}\n"


def run(tmp_path, setup, orders, more=""):
    return ran(tmp_path, ONE.replace("SETUP", setup) + more, orders)


def test_a_change_of_product_costs_what_the_matrix_says(tmp_path):
    log = run(tmp_path, "{times: {a: {b: 3 s}, b: {a: 5 s}}, otherwise: 7 s, attended: false}", "0,a 0,b 0,a 0,c 0,c")
    assert spans(log, "setup") == [("b", 10, 13), ("a", 23, 28), ("c", 38, 45)]
    assert spans(log, "work") == [("a", 0, 10), ("b", 13, 23), ("a", 28, 38), ("c", 45, 55), ("c", 55, 65)]


def test_the_first_job_finds_the_server_as_it_needs_it_unless_said(tmp_path):
    other = run(tmp_path, "{otherwise: 7 s, attended: false, first: a}", "0,b")
    assert spans(other, "setup") == [("b", 0, 7)]
    assert spans(run(tmp_path, "{otherwise: 7 s, attended: false}", "0,b"), "setup") == []


def test_families_tell_apart_by_family(tmp_path):
    log = run(tmp_path, "{otherwise: 7 s, by: family, attended: false}", "0,a 0,b 0,c")
    assert spans(log, "setup") == [("c", 20, 27)]


def test_the_same_again_costs_only_what_is_said_of_it(tmp_path):
    log = run(tmp_path, "{times: {a: {a: 1 s}}, otherwise: 7 s, attended: false}", "0,a 0,a 0,a")
    assert spans(log, "setup") == [("a", 10, 11), ("a", 21, 22)]


def test_no_time_is_no_setup(tmp_path):
    assert spans(run(tmp_path, "{otherwise: 0 s, attended: false}", "0,a 0,b"), "setup") == []


def test_a_worker_with_the_skill_sets_up_at_his_own_pace(tmp_path):
    log = run(tmp_path, "{otherwise: 6 s}", "0,a 0,b", WORKER)
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
    log = run(tmp_path, "{times: {a: {b: wash}}, otherwise: change}", "0,a 0,b 0,c", WORKER)
    assert spans(log, "setup") == [("b", 10, 12), ("b", 12, 14), ("b", 14, 16), ("c", 26, 28)]


def test_each_server_remembers_what_it_did_and_the_nearest_one_is_taken(tmp_path):
    text = ONE.replace("SETUP", "{otherwise: 7 s, attended: false}").replace("tasks: [cut]", "tasks: [cut], servers: 2")
    log = ran(tmp_path, text, "0,a 0,b 20,b 20,a 40,b")
    assert spans(log, "setup") == []
    log = ran(tmp_path, text, "0,a 0,b 20,c")
    assert spans(log, "setup") == [("c", 20, 27)]


def test_least_setup_stays_with_a_product_as_long_as_there_are_jobs_of_it(tmp_path):
    orders = "0,a 1,b 2,c 3,a 4,b 5,c"
    setup = "{times: {a: {b: 1 s, c: 2 s}}, otherwise: 3 s, attended: false}"
    assert begun(run(tmp_path, setup, orders)) == "abcabc"
    assert begun(run(tmp_path, setup, orders, "flow: {dispatch: least_setup}\n")) == "aabbcc"


def test_jobs_in_turn_of_equal_setups_come_in_any_order_of_declaration(tmp_path):
    lines = ONE.replace("SETUP", "{otherwise: 7 s, attended: false}").strip().splitlines()
    there, back = ("\n".join(part) for part in (lines, lines[::-1]))
    orders = "0,c 0,b 0,a 0,c 0,a"
    assert spans(ran(tmp_path, there, orders), "work") == spans(ran(tmp_path, back, orders), "work")


@pytest.mark.parametrize("attended", ["true", "false"])
def test_a_breakdown_in_a_setup_only_puts_it_off(tmp_path, attended):
    jam = "breakdowns: {jam: {every: {fixed: 12 s}, repair: {fixed: 5 s}}}"
    text = ONE.replace("SETUP}", f"{{otherwise: 8 s, attended: {attended}}}, {jam}}}")
    log = ran(tmp_path, text + WORKER.replace("2.0", "1.0"), "0,a 0,b")
    assert spans(log, "setup") == [("b", 10, 12), ("b", 17, 23)]


def test_setting_up_is_work_of_the_body_too(tmp_path):
    from opsim.ergonomics.pieces import pieces_in_window
    from opsim.plan import compile_plan
    from opsim.scenario.read import scenarios_in

    text = HEAD + ONE.replace("SETUP", "{otherwise: change}") + WORKER
    log = ran(tmp_path, ONE.replace("SETUP", "{otherwise: change}") + WORKER, "0,a 0,b")
    pieces = pieces_in_window(log, compile_plan(scenarios_in(text.encode(), tmp_path / "shop.yaml")["base"]))
    assert pieces.seconds.tolist() == [2.0] and pieces.k.tolist() == [0]
