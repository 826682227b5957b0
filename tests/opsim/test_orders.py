"""Lists of orders and sequences: read as written, and every mistake told with its line."""

import math

import pytest

from opsim.csv_input import MOST_OF_AN_ORDER, Mistake, Order, RecordedError, read_orders, read_sequence
from opsim.problems import ScenarioError
from opsim.shipped import find_scenario, shipped_folder, shipped_scenarios

PRODUCTS = ("a", "b", "board")


def written(folder, text, name="orders.csv"):
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def test_times_are_seconds_or_hours_and_minutes_and_stand_on_the_grid(tmp_path):
    text = "time,product\n0,a\n12.3,b\n0:00:30.5,b\n1:00,a\n"
    orders, wrong = read_orders(written(tmp_path, text), PRODUCTS)
    assert not wrong
    assert [order.time_s for order in orders] == [0.0, round(12.3 * 2**20) / 2**20, 30.5, 3600.0]


def test_orders_of_one_time_keep_the_order_of_the_file(tmp_path):
    orders, _ = read_orders(written(tmp_path, "product;time\nb;1\nb;5\na;5\n"), PRODUCTS)
    assert [order.product for order in orders] == ["b", "b", "a"]


def test_times_that_go_backwards_are_told_where_they_do(tmp_path):
    _, wrong = read_orders(written(tmp_path, "product,time\na,10\na,5\na,7\na,0:00:06\n"), PRODUCTS)
    assert [(one.line, one.cell, one.message) for one in wrong] == [
        (3, 1, "time '5' is before that of the order above"),
        (5, 1, "time '0:00:06' is before that of the order above"),
    ]


def test_what_is_not_said_of_an_order_is_left_to_others(tmp_path):
    file = written(tmp_path, "time,product,quantity,due,priority\n1,a,,,\n2,b,3,1:00,-2\n")
    orders, wrong = read_orders(file, PRODUCTS)
    assert (orders, wrong) == ([Order(1.0, "a"), Order(2.0, "b", 3, 3600.0, -2)], [])
    assert (orders[0].due_s, orders[0].priority) == (math.inf, None)


def test_every_mistake_of_a_file_is_told_with_its_line(tmp_path):
    text = "time,product,quantity,due,priority\n-1,a,1,,\nx,bord,0,9:99,high\n3,,2,,\n"
    _, wrong = read_orders(written(tmp_path, text), PRODUCTS)
    time = "from 0 on, such as 90 or 0:01:30"
    assert wrong == [
        Mistake(2, 0, "time '-1' is not a time in seconds or as h:mm:ss", time),
        Mistake(3, 0, "time 'x' is not a time in seconds or as h:mm:ss", time),
        Mistake(3, 1, "no product 'bord'", "did you mean 'board'?"),
        Mistake(3, 2, f"quantity '0' is not a whole number from 1 to {MOST_OF_AN_ORDER:,}", "such as 1"),
        Mistake(3, 3, "due '9:99' is not a time in seconds or as h:mm:ss", time),
        Mistake(3, 4, "priority 'high' is not a whole number", "such as 2"),
        Mistake(4, 1, "there is no product", "fill the cell, or remove the line"),
    ]


def test_a_row_with_more_values_than_columns_is_told_and_blank_cells_are_none(tmp_path):
    hint = "write decimals with a point, and text that holds a comma in quotes"
    _, wrong = read_orders(written(tmp_path, "time,product\n0,a,,\n10,b,7,2,3\n"), PRODUCTS)
    assert wrong == [Mistake(3, 2, "5 values, the first line has 2", hint)]
    _, wrong = read_sequence(written(tmp_path, "product\na\nb,2\n"), PRODUCTS)
    assert wrong == [Mistake(3, 1, "2 values, the first line has 1", hint)]


@pytest.mark.parametrize(("text", "said"), [
    ("product\na\n", "no column 'time'"),
    ("time,prodct\n1,a\n", "a column 'prodct'; did you mean 'product'?"),
    ("time,time\n1,2\n", "two columns 'time'"),
    ("time,product\n", "no rows below its heading"),
    ("", "is empty"),
])  # fmt: skip
def test_a_file_that_is_no_list_of_orders_is_refused(tmp_path, text, said):
    with pytest.raises(RecordedError, match="orders") as caught:
        read_orders(written(tmp_path, text), PRODUCTS)
    assert said in str(caught.value)


@pytest.mark.parametrize("cell", ["nan", "inf", "1e999", "-0.1", "1e99", "1:5", "1:60", "a:00"])
def test_no_time_is_negative_endless_or_beyond_the_clock(tmp_path, cell):
    _, wrong = read_orders(written(tmp_path, f"time\n{cell}\n"), PRODUCTS)
    assert len(wrong) == 1


def test_a_sequence_holds_each_product_as_often_as_its_quantity_says(tmp_path):
    sequence, wrong = read_sequence(written(tmp_path, "product,quantity\na,2\nb,\na,1\n"), PRODUCTS)
    assert (sequence, wrong) == (["a", "a", "b", "a"], [])


def test_a_sequence_tells_products_that_are_not_there(tmp_path):
    _, wrong = read_sequence(written(tmp_path, "product\na\nc\n"), PRODUCTS)
    assert wrong == [Mistake(3, 0, "no product 'c'", "products: a, b, board")]


def test_a_file_that_exists_is_itself(tmp_path):
    file = tmp_path / "queue.yaml"
    file.write_text("opsim: 1\n")
    assert find_scenario(file) == file


def test_a_shipped_scenario_is_found_by_its_name(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("opsim.shipped.shipped_folder", lambda: tmp_path / "shipped")
    (tmp_path / "shipped").mkdir()
    (tmp_path / "shipped/queue.yaml").write_text("opsim: 1\n")
    assert shipped_scenarios() == ["queue"]
    for name in ("queue", "queue.yaml", "scenarios/queue.yaml"):
        assert find_scenario(name) == tmp_path / "shipped/queue.yaml"
    with pytest.raises(ScenarioError, match=r"did you mean 'queue\.yaml'"):
        find_scenario("queu.yaml")
    (tmp_path / "low.yaml").touch()
    with pytest.raises(ScenarioError, match=r"here are low\.yaml; 'opsim init --list' shows those that come with"):
        find_scenario("nope.yaml")  # only its ending is like that of the others
    with pytest.raises(ScenarioError, match="no such file"):
        find_scenario("other/queue.yaml")
    with pytest.raises(ScenarioError, match="no such file"):
        find_scenario("a\0b")


def test_the_shipped_folder_is_there():
    assert shipped_folder().is_dir()
