"""Mistakes in the flow of material: ``check`` and ``run`` refuse them alike, each with its place and a remedy."""

import pytest

from tests.opsim.cli.calls import line, opsim

PLANT = """
opsim: 1
name: Plant
run: {horizon: 8 h, replications: 1}
layout:
  distance: paths
  places: {here: [0 m, 0 m], there: [9 m, 0 m], yard: [90 m, 0 m]}
  paths: [[here, there]]
tasks: {do: {fixed: 30 s, automatic: true}}
stores: {rack: {at: here, capacity: 9}}
stations:
  cut: {at: here, tasks: [do], buffer: 3}
  fit: {at: there, tasks: [do], buffer: 3, maintenance: {oiling: {every: 2 h, lasts: 10 min}}}
  test: {at: there, tasks: [do], buffer: 3}
cards: {loop: {n: 4, from: cut, to: fit}}
transporters: {cart: {at: here, speed: 1 m/s, legs: [[cut, fit]], roads: [[here, there]]}}
products:
  bike: {route: [cut, fit, test], parts: {fit: {wheel: 2}}}
  wheel: {route: [cut, rack]}
  trial: {routing: {start: cut, cut: {test: 0.5, out: 0.5}, test: out}}
sources:
  calls: {kind: poisson, every: 10 min, products: [bike, trial]}
  refill: {kind: base_stock, store: rack, level: 4}
"""
OILING = "every: 2 h, lasts: 10 min"
WRONG = {
    "a kanban loop without cards": ("loop: {n: 4", "loop: {n: 0", "cards.loop.n", "n: 1"),
    "a bill of material that needs itself": (
        *("wheel: {route: [cut, rack]}", "wheel: {route: [cut, rack], parts: {cut: {wheel: 1}}}"),
        *("products.wheel.parts", "wheel needs wheel"),
    ),
    "a bill of material in a circle": (
        *("wheel: {route: [cut, rack]}", "wheel: {route: [cut, rack], parts: {cut: {bike: 1}}}"),
        *("products.", "needs"),
    ),
    "probabilities that sum to 1.2": ("{test: 0.5, out: 0.5}", "{test: 0.7, out: 0.5}", "trial.routing.cut", "1.2"),
    "a buffer of -1": ("[do], buffer: 3}\n  fit", "[do], buffer: -1}\n  fit", "stations.cut.buffer", "at least 0"),
    "a transporter without a road": ("roads: [[here, there]]", "roads: [[here, yard]]", "transporters.cart", "no road"),
    "maintenance longer than its period": (OILING, "every: 2 h, lasts: 3 h", "maintenance.oiling.lasts", "shorter"),
    "maintenance longer than the run": (OILING, "every: 90 h, first: 1 h, lasts: 9 h", "maintenance.oiling", "run"),
    "a route that skips where a part goes in": ("route: [cut, fit,", "route: [cut,", "products.bike.parts", "add fit"),
}
"""By what is wrong: what stands in the plant, what in its place, the place of the complaint, a word of the remedy."""


def test_the_plant_without_mistakes_is_fine(tmp_path):
    code, shown, complaint = opsim("check", line(tmp_path, PLANT))
    assert code == 0, complaint
    assert "no problems found" in shown


@pytest.mark.parametrize("what", WRONG)
def test_check_and_run_refuse_alike(tmp_path, what):
    old, new, place, remedy = WRONG[what]
    assert old in PLANT
    path = line(tmp_path, PLANT.replace(old, new))
    code, shown, complaint = opsim("check", path)
    assert (code, shown) == (2, "")
    assert f"{path.name}:" in complaint and place in complaint and remedy in complaint
    assert opsim("run", path, "-o", tmp_path / "out") == (code, shown, complaint)
    assert not (tmp_path / "out").exists()


def test_all_of_them_are_said_at_once(tmp_path):
    text = PLANT
    for old, new, _, _ in WRONG.values():
        text = text.replace(old, new)
    _, _, complaint = opsim("check", line(tmp_path, text))
    places = ["cards.loop.n", "trial.routing.cut", "cut.buffer", "fit.maintenance.oiling", "transporters.cart"]
    assert all(place in complaint for place in places)
