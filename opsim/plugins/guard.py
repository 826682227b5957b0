"""Whose mistake it is: a plug-in that fails is named with its distribution, entry point, file and exception.

What a plug-in's callable takes: asked before it is used, so that a wrong signature is found at the door.

A plug-in's TaskModel with a guard around it: what it gives is checked, what it raises is its own mistake.

The guard at the door: a part of each group is made safe to use, or its plug-in is blamed.
"""

from __future__ import annotations

import inspect
import linecache
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import wraps
from traceback import walk_tb
from typing import TYPE_CHECKING, Any

from opsim.engine.rules import ALLOCATION_RULES, ROTATION_RULES, ROUTING_RULES, SEQUENCING_RULES
from opsim.kpi.catalogue import DECLARED
from opsim.plugins.subjects import STATION, Subject
from opsim.problems import PluginError, shown
from opsim.task_model import TaskModel

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

    import numpy as np

OURS = "opsim"


@dataclass(frozen=True)
class Found:
    """An entry point that was found; nothing of it is imported yet."""

    entry_point: EntryPoint

    @property
    def distribution(self) -> str:
        """Name and version of what was installed, e.g. ``opsim-example-plugin 0.1.0``."""
        dist = self.entry_point.dist
        return "an unknown distribution" if dist is None else f"{dist.name} {dist.version}"

    @property
    def is_ours(self) -> bool:
        return self.entry_point.dist is not None and self.entry_point.dist.name == OURS

    def __str__(self) -> str:
        point = self.entry_point
        return f"{self.distribution} ({point.group}: {point.name} = {point.value})"


def fault(found: Found, what: str, place: str = "") -> PluginError:
    """The error of a plug-in that does what it should not."""
    point = found.entry_point
    lines = [f"plug-in {point.name!r} of {found.distribution}: {what}", place or _file_of(found)]
    lines.append(f"entry point {point.group}: {point.name} = {point.value}")
    return PluginError("\n  ".join(line for line in lines if line))


@contextmanager
def blamed(found: Found, doing: str) -> Iterator[None]:
    """What goes wrong inside is the plug-in's mistake. Ctrl-C is nobody's."""
    try:
        yield
    except PluginError:
        raise
    except (Exception, SystemExit) as error:
        raise fault(found, f"{doing}: {type(error).__name__}: {error}", place_of(found, error)) from error


def place_of(found: Found, error: BaseException) -> str:
    """File, line and source of the plug-in's innermost frame, or of the text that does not parse."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}: {(error.text or '').strip()}"
    package = found.entry_point.module.partition(".")[0]
    for frame, line in reversed(list(walk_tb(error.__traceback__))):
        if str(frame.f_globals.get("__name__", "")).partition(".")[0] == package:
            file = frame.f_code.co_filename
            return f"{file}:{line}: {linecache.getline(file, line).strip()}"
    return ""


def _file_of(found: Found) -> str:
    """The file of the module that the entry point names, where it could be imported."""
    return getattr(sys.modules.get(found.entry_point.module), "__file__", None) or ""


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


class GuardedModel:
    """The TaskModel of a plug-in; what it has beyond the seam is found through the guard too."""

    def __init__(self, found: Found, model: Any):
        self.found, self._model = found, model

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._model, name)

    def mean_duration_s(self, worker: Any = None) -> float:
        """As ``TaskModel``, and a positive number."""
        with blamed(self.found, "failed in mean_duration_s"):
            mean_s = float(self._model.mean_duration_s(worker))
        if not 0 < mean_s < math.inf:
            raise fault(self.found, f"mean_duration_s gave {mean_s:g}, expected a positive number of seconds")
        return mean_s

    def draw_worker(self, rng: np.random.Generator, body: Any = None, **more: Any) -> Any:
        """As ``TaskModel``."""
        with blamed(self.found, "failed in draw_worker"):
            return self._model.draw_worker(rng, body, **more)

    def sample(self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None) -> Any:
        """As ``TaskModel``; n positive durations, and marks for each."""
        import numpy as np

        with blamed(self.found, f"failed as it drew {n} performances"):
            drawn = self._model.sample(n, rng, worker=worker, condition=condition)
            duration_s, mark_s = np.asarray(drawn.duration_s, dtype=float), np.asarray(drawn.mark_s)
        if duration_s.shape != (n,) or mark_s.ndim != 2 or len(mark_s) != n:
            shapes = f"durations {duration_s.shape} and marks {mark_s.shape}"
            raise fault(self.found, f"sample gave {shapes}, expected ({n},) and ({n}, marks)")
        good = (duration_s > 0) & np.isfinite(duration_s)
        if not good.all():
            raise fault(self.found, f"sample gave a duration of {duration_s[~good][0]:g} s, expected positive numbers")
        return drawn


def guarded_model(found: Found, model: Any) -> GuardedModel:
    """A model that has the three methods of the seam, to be called as they will be. Raises PluginError."""
    for name in ("mean_duration_s", "draw_worker", "sample"):
        if isinstance(model, type) or not callable(getattr(model, name, None)):
            raise fault(found, f"expected a TaskModel with {name}, found {worded(model)}")
        must_take(found, getattr(model, name), like=getattr(TaskModel, name))
    return GuardedModel(found, model)


def guarded_rule(found: Found, rule: Any, like: Callable) -> Callable[..., tuple[float, ...]]:
    """A rule that takes the arguments of ours and gives a key of numbers."""
    must_take(found, rule, like=like)

    @wraps(rule)
    def key_of(*numbers: float) -> tuple[float, ...]:
        with blamed(found, "failed as it chose"):
            key = rule(*numbers)
        sound = isinstance(key, tuple) and all(isinstance(part, int | float) and part == part for part in key)
        if not sound or not key:
            raise fault(found, f"expected a key, a tuple of one or more numbers, found {repr(key)[:80]}")
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


def guarded_subject(found: Found, subject: Any) -> Subject:
    """A subject of the floor whose key and figures are nobody else's, and whose functions are its own responsibility.

    Raises PluginError.
    """
    from opsim.scenario.schema import Block, Scenario, Station

    if not isinstance(subject, Subject) or not issubclass(subject.words, Block):
        raise fault(found, f"expected a Subject whose words are a Block, found {worded(subject)}")
    key, beside = found.entry_point.name, Station if subject.where == STATION else Scenario
    ours = {field.alias or name for name, field in beside.model_fields.items()} | {*dir(beside), "like"}
    if not key.isidentifier() or key in ours:
        raise fault(found, f"no key of a {subject.where} can be called {key!r}")
    if taken := {one.name for one in DECLARED} & {one.name for one in subject.kpis}:
        raise fault(found, f"figures of ours are called {', '.join(sorted(taken))}")
    own: Any = {
        name: _owned(found, f"failed in {name}", getattr(subject, name))
        for name in ("plan", "install", "mistakes", "tasks", "figures", "assumptions")
    }
    laws = {sentence: _owned(found, "failed in a law", law) for sentence, law in subject.laws.items()}
    sections = tuple(_owned(found, "failed in a section of the report", make) for make in subject.sections)
    return replace(subject, laws=laws, sections=sections, **own)


def _owned(found: Found, doing: str, function: Callable) -> Callable:
    """A function whose failures are its plug-in's; what it yields is all there when it returns."""

    def call(*given: Any) -> Any:
        with blamed(found, doing):
            made = function(*given)
            return list(made) if isinstance(made, Iterator) else made

    return call


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
    "opsim.subjects": guarded_subject,
    "opsim.human": unguarded,
}
