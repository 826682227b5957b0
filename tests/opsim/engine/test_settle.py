"""The dispatch of the SimPy engine where it comes to no rest."""

from types import SimpleNamespace

import pytest

from opsim.engine.simpy_engine import settle
from opsim.engine.simpy_engine.settle import EndlessInstant, dispatch


def gate(*names):
    return SimpleNamespace(stations=[SimpleNamespace(plan=SimpleNamespace(name=name)) for name in names])


def test_an_instant_without_an_end_names_its_stations_in_order_and_each_once(monkeypatch):
    """Gates that are still moving are a set, in which they stand as their memory has it."""
    monkeypatch.setattr(settle, "admit", lambda floor: None)
    moving = [gate("saw", "press"), gate("drill", "saw"), gate("anvil")]
    floor = SimpleNamespace(stirred=moving, saturated=[], losing=False, dispatchers=[], free=[], now=60.0)
    with pytest.raises(EndlessInstant, match=r"^t = 60\.0 s: .* still moving at: anvil, drill, press, saw$"):
        dispatch(floor)
