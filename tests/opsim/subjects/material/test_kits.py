"""Bills of material and stores: known answers by hand, and the laws."""

import numpy as np
import plans
import pytest
from made import shops as made_shops
from plans import plan

from opsim import log as kinds
from opsim.engine.floor.run import run_plan

BIKES = """
opsim: 1
name: bikes
run: {horizon: 200 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {join: {fixed: 10 s, automatic: true}}
stores: {wheels: {at: here, capacity: 4}, frames: {at: here}}
stations: {join: {at: here, tasks: [join], buffer: 1}}
products:
  wheel: {route: [wheels]}
  frame: {route: [frames]}
  bike: {route: [join], parts: {join: {wheel: 2, frame: 1}}}
sources:
  wheels: {kind: renewal, every: {fixed: 6 s}, products: [wheel]}
  frames: {kind: renewal, every: {fixed: 20 s}, products: [frame]}
  bikes: {kind: saturated, products: [bike]}
"""


def ran(*edits):
    return plans.ran(BIKES, *edits)[0]


def times(log, kind, column="end_s", **wanted):
    """When rows of a kind end, those of a product and a cause."""
    rows = log.of(kind)
    for name, value in wanted.items():
        rows = rows.where(rows[name] == log.names[name].index(value))
    return rows[column].tolist()


def test_a_bike_takes_two_wheels_and_a_frame_when_all_are_there():
    """Wheels at 6, 12, ...; frames at 20, 40, ...: the frame is late, work lasts 10 s, a bike every 20 s."""
    log = ran()
    assert times(log, kinds.FINISH) == [30.0 + 20 * i for i in range(9)]
    assert times(log, kinds.JOIN, product="frame") == [20.0 * i for i in range(1, 10)]
    assert times(log, kinds.JOIN, product="wheel") == [20.0 * i for i in range(1, 10) for _ in range(2)]
    waits = [20.0, *[10.0] * 9]
    found = log.where((log["kind"] == kinds.HELD) & (log["product"] == log.names["product"].index("bike")))
    found = found.where(found["station"] >= 0)
    assert found.duration_s.tolist() == waits and set(found["cause"]) == {kinds.NO_PARTS}


def test_what_joins_names_the_bike_and_where():
    log = ran()
    joined = log.of(kinds.JOIN)
    bikes = log.of(kinds.FINISH)["job"]
    assert np.array_equal(joined["k"][: 3 * bikes.size], np.repeat(bikes, 3))
    assert {log.names["station"][rank] for rank in joined["station"]} == {"join"}


def test_a_full_store_holds_up_who_comes_and_takes_the_one_that_came_first():
    """Two wheels leave at 20, 40, ... s; those of 6, ..., 48 s find room, that of 54 s comes in with that of 60 s."""
    log = ran()
    lying = log.where((log["kind"] == kinds.QUEUE) & (log["cause"] == kinds.STOCK))
    wheels = lying.where(lying["product"] == log.names["product"].index("wheel"))
    starts = np.sort(wheels["start_s"])
    assert starts[:10].tolist() == [6, 12, 18, 24, 30, 36, 42, 48, 60, 60]
    assert max(np.searchsorted(starts, t, "right") - np.sum(wheels["end_s"] <= t) for t in starts) == 4
    order = np.argsort(wheels["job"])
    assert np.all(np.diff(wheels["end_s"][order]) >= 0)


def test_what_lies_there_at_the_start_is_taken_first():
    log = ran(("capacity: 4", "capacity: 4, initial: 2"), ("frames: {at: here", "frames: {at: here, initial: 1"))
    assert times(log, kinds.FINISH)[:3] == [10.0, 30.0, 50.0]
    made = log.of(kinds.CREATE)
    first = made.where((made["end_s"] == 0) & (made["station"] >= 0))
    assert [log.names["source"][s] for s in first["source"]] == ["stock: frames", "stock: wheels", "stock: wheels"]


def test_a_bike_that_needs_less_passes_one_that_waits_for_more():
    """The first bike wants 3 wheels, the scooter 2 and no frame: it has them at 12 s, the bike at 30 s."""
    log = ran(
        ("bike: {route: [join], parts: {join: {wheel: 2, frame: 1}}}",
         "bike: {route: [join], parts: {join: {wheel: 3}}}\n  scooter: {route: [join], parts: {join: {wheel: 2}}}"),
        ("tasks: [join]", "servers: 2, tasks: [join]"),
        ("kind: saturated, products: [bike]", "kind: saturated, sequence: [bike, scooter]"),
    )  # fmt: skip
    done = log.of(kinds.FINISH)
    assert [log.names["product"][p] for p in done["product"]][:2] == ["scooter", "bike"]
    assert done["end_s"].tolist()[:2] == [22.0, 40.0]


def test_the_one_who_waited_longer_is_served_first():
    """Two bikes wait for one frame: the one that came first has it."""
    log = ran(("tasks: [join]", "servers: 2, tasks: [join]"))
    assert log.of(kinds.FINISH)["job"].tolist() == [3 * n for n in range(9)]


def test_a_higher_priority_has_the_parts_first():
    log = ran(
        ("bike: {", "urgent: {priority: 1, route: [join], parts: {join: {wheel: 2, frame: 1}}}\n  bike: {"),
        ("tasks: [join]", "servers: 2, tasks: [join]"),
        ("kind: saturated, products: [bike]", "kind: saturated, sequence: [bike, urgent, bike, bike]"),
    )
    assert [log.names["product"][p] for p in log.of(kinds.FINISH)["product"]][:2] == ["urgent", "bike"]


def test_a_lot_needs_parts_for_each_unit_and_gives_them_unit_by_unit():
    """A lot of 2 bikes takes 4 wheels out of lots of 3: one lot and a third of the next; 2 x 10 s of work."""
    log = ran(
        ("bike: {", "bike: {lot: 2, "), ("wheel: {route", "wheel: {lot: 3, route"), ("wheel: 2, frame: 1", "wheel: 2")
    )
    assert times(log, kinds.JOIN)[:4] == [12.0, 32.0, 52.0, 52.0]  # 3 + 1 of 3, 2 + 2 of 3, 1 + 3
    assert times(log, kinds.FINISH)[:3] == [32.0, 52.0, 72.0]
    assert log.of(kinds.WORK).duration_s[:4].tolist() == [10.0] * 4


def test_parts_go_in_once_however_often_the_job_comes_back():
    """A bike comes by twice, and takes 2 wheels and a frame at its first visit."""
    log = ran(("bike: {route: [join]", "bike: {route: [join, join]"))
    _, n_parts = np.unique(log.of(kinds.JOIN)["k"], return_counts=True)
    visits = [np.sum(log.of(kinds.WORK)["job"] == job) for job in log.of(kinds.FINISH)["job"]]
    assert set(n_parts) == {3} and set(visits) == {2}


def test_a_defect_in_a_part_is_in_the_bike():
    text = BIKES.replace("wheel: {route: [wheels]}", "wheel: {route: [spoke, wheels]}").replace(
        "stations: {", "stations: {spoke: {at: here, tasks: [spoke], yield: 0.5}, "
    )
    log = run_plan(plan(text.replace("tasks: {", "tasks: {spoke: {fixed: 1 s, automatic: true}, ")))
    share = np.mean(log.of(kinds.FINISH)["cause"] == kinds.BAD)
    assert 0 < share <= 1


def test_a_product_by_routing_may_end_in_a_store():
    log = ran(
        ("frame: {route: [frames]}", "frame: {routing: {start: weld, weld: {frames: 0.5, out: 0.5}}}"),
        ("stations: {", "stations: {weld: {at: here, tasks: []}, "),
    )
    used, scrapped = (len(times(log, kind, product="frame")) for kind in (kinds.JOIN, kinds.FINISH))
    assert used + scrapped == 9 and used > 0 and scrapped > 0


@pytest.mark.parametrize("edit", [
    ("wheel: 2, frame: 1}}}", "frame: 1, wheel: 2}}}"),
    ("wheel: {route: [wheels]}\n  frame: {route: [frames]}", "frame: {route: [frames]}\n  wheel: {route: [wheels]}"),
    ("{wheels: {at: here, capacity: 4}, frames: {at: here}}", "{frames: {at: here}, wheels: {at: here, capacity: 4}}"),
])  # fmt: skip
def test_the_order_of_declaration_decides_nothing(edit):
    one, other = ran(), ran(edit)
    assert one.names == other.names
    assert all(np.array_equal(one[c], other[c], equal_nan=True) for c in one.columns)


def test_a_bad_part_goes_into_the_job_of_a_batch_that_takes_it(tmp_path):
    text = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {cast: {at: hall, tasks: [cut], yield: 0.001}, saw: {at: hall, tasks: [cut], batch: {size: 2}}}
stores: {bin: {at: hall}}
products: {bolt: {route: [cast, bin]}, a: {route: [saw], parts: {saw: {bolt: 1}}}}
"""
    log = made_shops.ran(tmp_path, text, "0,bolt 0,bolt 0,a 0,a")
    assert made_shops.spans(log, "finish", cause="bad") == [("a", 30, 30), ("a", 30, 30)]
    joined = log.of(kinds.JOIN)
    assert joined["k"].tolist() == [2, 3]
