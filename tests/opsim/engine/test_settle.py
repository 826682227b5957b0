"""Dispatching where it comes to no rest."""

from types import SimpleNamespace

import pytest

from opsim.engine.endless import EndlessInstant, endless_instant
from opsim.engine.floor import settle
from opsim.engine.floor.settle import ENDLESS, dispatch

NAMES = ("saw", "press", "drill", "anvil")
PLAN = SimpleNamespace(stations=[SimpleNamespace(name=name) for name in NAMES])


def gate(*names):
    stations = [SimpleNamespace(rank=NAMES.index(name)) for name in names]
    return SimpleNamespace(stations=stations, n_stations=len(stations))


def test_an_instant_without_an_end_names_its_stations_in_order_and_each_once(monkeypatch):
    """Gates that are still moving stand in no order of their names."""
    monkeypatch.setattr(settle, "_admit", lambda floor: None)
    moving = [gate("saw", "press"), gate("drill", "saw"), gate("anvil")]
    floor = SimpleNamespace(stirred=moving, saturated=[], losing=False, dispatchers=[], free=[], now=60.0, error=0)
    dispatch(floor)
    assert floor.error == ENDLESS
    with pytest.raises(EndlessInstant, match=r"^t = 60\.0 s: .* still moving at: anvil, drill, press, saw$"):
        raise endless_instant(PLAN, floor)
