"""The guard at the door: a part of each group is made safe to use, or its plug-in is blamed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

from opsim.engine.rules import ALLOCATION_RULES, ROTATION_RULES, ROUTING_RULES, SEQUENCING_RULES
from opsim.plugins.blame import Found, blamed, fault
from opsim.plugins.model import guarded_model
from opsim.plugins.taking import must_take, signature_of, worded


def guarded_rule(found: Found, rule: Any, like: Callable) -> Callable[..., tuple[float, ...]]:
    """A rule that takes the arguments of ours and gives a key of numbers."""
    must_take(found, rule, like=like)

    @wraps(rule)
    def key_of(*numbers: float) -> tuple[float, ...]:
        with blamed(found, "failed as it chose"):
            key = rule(*numbers)
        if not isinstance(key, tuple) or not all(isinstance(part, int | float) and part == part for part in key):
            raise fault(found, f"expected a key, a tuple of numbers, found {repr(key)[:80]}")
        return key

    return key_of


def guarded_factory(found: Found, factory: Any, check: Callable[[Found, Any], Any]) -> Callable[..., Any]:
    """A callable that makes a part from parameters given by name; ``inspect.signature`` tells which.

    It raises ValueError for parameters that are wrong or refused (the caller's mistake), PluginError otherwise.
    """
    signature, name = signature_of(found, factory), found.entry_point.name

    def make(**given: Any) -> Any:
        try:
            signature.bind(**given)
        except TypeError as error:
            raise ValueError(f"plug-in {name}{signature}: {error}") from None
        part: Any = None
        refused: ValueError | None = None
        with blamed(found, "failed as it was set up"):
            try:
                part = factory(**given)
            except ValueError as error:
                refused = error
        if refused is not None:
            raise ValueError(f"plug-in {name}: {refused}") from refused
        return check(found, part)

    make.__name__, make.__doc__ = name, factory.__doc__
    make.__signature__ = signature  # type: ignore[attr-defined]
    return make


def station_block(found: Found, block: Any) -> dict[str, Any]:
    """The block of a station, as a scenario has it."""
    if not isinstance(block, Mapping):
        raise fault(found, f"expected the block of a station, a mapping, found {worded(block)}")
    return dict(block)


def unguarded(_found: Found, part: Any) -> Any:
    """For groups that nothing uses yet."""
    return part


GUARDS: dict[str, Callable[[Found, Any], Any]] = {
    "opsim.dispatch": lambda found, rule: guarded_rule(found, rule, ALLOCATION_RULES["nearest"]),
    "opsim.routing": lambda found, rule: guarded_rule(found, rule, ROUTING_RULES["in_order"]),
    "opsim.rotation": lambda found, rule: guarded_rule(found, rule, ROTATION_RULES["in_turn"]),
    "opsim.sequencing": lambda found, rule: guarded_rule(found, rule, SEQUENCING_RULES["fifo"]),
    "opsim.emulators": lambda found, factory: guarded_factory(found, factory, guarded_model),
    "opsim.stations": lambda found, factory: guarded_factory(found, factory, station_block),
    "opsim.human": unguarded,
}
