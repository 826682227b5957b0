"""What a plug-in's callable takes: asked before it is used, so that a wrong signature is found at the door."""

from __future__ import annotations

import inspect
from typing import Any

from opsim.plugins.blame import Found, blamed, fault
from opsim.problems import shown


def signature_of(found: Found, part: Any) -> inspect.Signature:
    """The signature of a callable. Raises PluginError where there is none."""
    if not callable(part):
        raise fault(found, f"expected something to call, found {worded(part)}")
    with blamed(found, "cannot say what parameters it takes"):
        return inspect.signature(part)


def must_take(found: Found, part: Any, like: Any) -> None:
    """Raises PluginError where a part cannot be called with all that ``like`` takes, in the same order and names."""
    signature = signature_of(found, part)
    expected = _without_self(inspect.signature(like))
    parameters = expected.parameters.values()
    by_order = [name for name, p in expected.parameters.items() if p.kind is not p.KEYWORD_ONLY]
    by_name = {p.name: None for p in parameters if p.kind is p.KEYWORD_ONLY}
    try:
        signature.bind(*by_order, **by_name)
    except TypeError as error:
        name = getattr(part, "__name__", type(part).__name__)
        raise fault(found, f"{name} takes {_plain(signature)}, expected {_plain(expected)}: {error}") from None


def worded(value: Any) -> str:
    """A value and its type, as a message names it."""
    return f"{shown(value)}, a {type(value).__name__}"


def _without_self(signature: inspect.Signature) -> inspect.Signature:
    return signature.replace(parameters=[p for p in signature.parameters.values() if p.name != "self"])


def _plain(signature: inspect.Signature) -> str:
    """The signature without types."""
    bare = inspect.Parameter.empty
    parameters = [p.replace(annotation=bare) for p in signature.parameters.values()]
    return str(signature.replace(parameters=parameters, return_annotation=inspect.Signature.empty))
