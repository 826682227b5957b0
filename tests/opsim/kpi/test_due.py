"""Due dates: by hand arithmetic."""

import pytest
from made_shops import HEAD
from plans import CELL, plan

from opsim.engine.floor import run_plan
from opsim.kpi.throughput import due_dates
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

SHOP = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut]}}
products: {a: {route: [saw], due: 15 s}, b: {route: [saw]}}
"""


def told(folder, orders):
    (folder / "orders.csv").write_text("\n".join(orders.split()) + "\n")
    made = compile_plan(scenarios_in((HEAD + SHOP).encode(), folder / "shop.yaml")["base"])
    return {(figure.kpi, figure.subject): figure.value for figure in due_dates(run_plan(made), made)}


def test_a_job_that_is_done_on_its_due_date_is_not_late_by_a_tick():
    text = HEAD.replace("{kind: schedule, file: orders.csv}", "{kind: renewal, every: {fixed: 9 s}}") + SHOP
    made = plan(
        text.replace("fixed: 10 s", "fixed: 6.3 s").replace(
            ", due: 15 s}, b: {", ", due: 6.3 s, share: 0.5}, b: {share: 0.5, "
        )
    )
    assert [figure.value for figure in due_dates(run_plan(made), made) if figure.kpi == "late_share"] == [0, 0]


def test_late_jobs_and_how_late_they_are(tmp_path):
    """Finished at 10, 20 and 30 s, due at 15 s each."""
    figures = told(tmp_path, "time,product 0,a 0,a 0,a")
    assert figures["late_share", ""] == pytest.approx(2 / 3)
    assert figures["tardiness_s", "a"] == pytest.approx((5 + 15) / 3)
    assert ("late_share", "b") not in figures


def test_the_order_says_its_own_due_date(tmp_path):
    """b without one, a due 15 s after it came, b due at 12 s."""
    figures = told(tmp_path, "time,product,due 0,b, 0,a, 0,b,12")
    assert figures == {
        ("late_share", ""): 1.0,
        ("late_share", "a"): 1.0,
        ("late_share", "b"): 1.0,
        ("tardiness_s", ""): pytest.approx((5 + 18) / 2),
        ("tardiness_s", "a"): 5.0,
        ("tardiness_s", "b"): 18.0,
    }


def test_without_due_dates_nothing_is_said():
    made = plan(CELL)
    assert list(due_dates(run_plan(made), made)) == []
