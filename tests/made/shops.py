"""Small shops whose orders come at given times, for tests of the sequence of work."""

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit
from opsim.log import KINDS
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

HEAD = """
opsim: 1
name: shop
run: {horizon: 200 s}
layout: {places: {hall: [0 m, 0 m]}}
release: {kind: schedule, file: orders.csv}
"""


def ran(folder, text, orders, head=HEAD):
    """The log of a shop; ``orders`` are lines such as ``0,a`` (time, product, and more where the first line says)."""
    lines = orders.split()
    heading = "" if lines[0].startswith("time") else "time,product\n"
    (folder / "orders.csv").write_text(heading + "\n".join(lines) + "\n")
    plan = compile_plan(scenarios_in((head + text).encode(), folder / "shop.yaml")["base"])
    log = run_plan(plan)
    audit(log, plan)
    return log


def spans(log, kind, station=None, cause=None):
    """(product, start, end) of the rows of a kind, at a station and with a cause where these are given, by time."""
    names = log.names
    rows = [
        (names["product"][log["product"][i]], float(log["start_s"][i]), float(log["end_s"][i]))
        for i in range(len(log))
        if log["kind"][i] == KINDS.index(kind)
        and (station is None or names["station"][log["station"][i]] == station)
        and (cause is None or names["cause"][log["cause"][i]] == cause)
    ]
    return sorted(rows, key=lambda row: (row[1], row[2], row[0]))


def begun(log, station=None):
    """Products in the order in which work on them began."""
    return "".join(product for product, _, _ in spans(log, "work", station))
