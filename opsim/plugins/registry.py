"""The door by which parts come in: entry points by group and name, ours as anybody's.

Subjects of the floor that somebody else adds, wherever a plan has them.

What a scenario says to a plug-in: quantities with their units become numbers in SI, all mistakes at once.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib.metadata import entry_points
from typing import Any

from opsim.engine.rules import ALLOCATION_RULES, ROTATION_RULES, ROUTING_RULES, SEQUENCING_RULES
from opsim.kpi.catalogue import CATALOGUE
from opsim.plugins.guard import GUARDS, Found, blamed, fault, place_of
from opsim.plugins.subjects import GROUP, Subject
from opsim.problems import NoSuchPlugin, PluginError, did_you_mean, natural_key, shown
from opsim.units import UnitError, parse

GROUPS = (
    *("opsim.emulators", "opsim.stations", "opsim.dispatch", "opsim.sequencing", "opsim.routing", "opsim.rotation"),
    *("opsim.subjects", "opsim.human"),
)
RULES: dict[str, Mapping[str, Callable[..., tuple[float, ...]]]] = {
    "opsim.dispatch": ALLOCATION_RULES,
    "opsim.sequencing": SEQUENCING_RULES,
    "opsim.routing": ROUTING_RULES,
    "opsim.rotation": ROTATION_RULES,
}
"""Our own rules by group: who is sent where, which waiting job is next, which of several stations a job goes to, who
takes a post."""


class Plugins(Mapping[str, Any]):
    """The parts of one group by name, in natural order; each is imported when it is first asked for.

    Raises NoSuchPlugin for an unknown name, PluginError for one that two distributions have or that cannot be used.
    """

    def __init__(self, group: str, found: dict[str, list[Found]]):
        self.group, self._found = group, found
        self._loaded: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._loaded:
            self._loaded[name] = _load(self.found(name))
        return self._loaded[name]

    def __contains__(self, name: object) -> bool:
        return name in self._found

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def found(self, name: str) -> Found:
        """Where a part comes from; nothing is imported."""
        if name not in self._found:
            raise NoSuchPlugin(f"{self.group}: no {shown(name)}; {did_you_mean(name, self._found) or 'none installed'}")
        first, *others = self._found[name]
        if others:
            both = "\n  ".join(str(found) for found in (first, *others))
            raise PluginError(f"{self.group}: {shown(name)} is the name of several parts; uninstall one\n  {both}")
        return first


def plugins(group: str) -> Plugins:
    """The installed parts of a group, e.g. ``plugins("opsim.dispatch")["nearest"]``. Raises ValueError for a group."""
    if group not in GROUPS:
        raise ValueError(f"plug-ins: no group {shown(group)}; {did_you_mean(group, GROUPS)}")
    found: dict[str, list[Found]] = {}
    for point in sorted(entry_points(group=group), key=lambda point: (natural_key(point.name), point.value)):
        found.setdefault(point.name, []).append(Found(point))
    return Plugins(group, found)


def dispatch_rule(name: str) -> Callable[..., tuple[float, ...]]:
    """The rule of allocation of that name."""
    return rule_of("opsim.dispatch", name)


def rule_of(group: str, name: str) -> Callable[..., tuple[float, ...]]:
    """The rule of that name in a group of ``RULES``: ours, else a plug-in. Raises NoSuchPlugin or PluginError."""
    ours = RULES[group].get(name)
    return plugins(group)[name] if ours is None else ours


def _load(found: Found) -> Any:
    with blamed(found, "cannot be imported"):
        part = found.entry_point.load()
    return part if found.is_ours else GUARDS[found.entry_point.group](found, part)


@cache
def installed() -> dict[str, Subject]:
    """All subjects that are installed, by key. Their figures are in the catalogue from now on. Raises PluginError."""
    if not entry_points(group=GROUP):
        return {}
    subjects = dict(plugins(GROUP))
    whose: dict[str, str] = {}
    for key, name in ((key, kpi.name) for key, one in subjects.items() for kpi in one.kpis):
        if whose.setdefault(name, key) != key:
            raise fault(plugins(GROUP).found(key), f"the figure {name} is one of the subject {whose[name]!r} too")
    CATALOGUE.update((kpi.name, kpi) for one in subjects.values() for kpi in one.kpis)
    return subjects


def subjects_of(plan: Any) -> Iterator[tuple[Subject, Any]]:
    """The subjects of somebody else that a plan has, each with what the plan keeps of it; in natural order of keys."""
    for one in plan.subjects:
        yield installed()[one.key], one.part


@contextmanager
def steps_blamed(plan: Any) -> Iterator[None]:
    """What goes wrong in a step of a subject is its plug-in's mistake. Raises PluginError."""
    try:
        yield
    except Exception as error:
        for one in plan.subjects:
            found = plugins(GROUP).found(one.key)
            if place := place_of(found, error):
                raise fault(found, f"failed on the floor: {type(error).__name__}: {error}", place) from error
        raise


KIND_OF_ENDING = {"_m_per_s": "speed", "_kg": "mass", "_s": "time", "_m": "length"}
PLUGIN = "plugin"
_BY_NAME = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


def plugin_model(name: str, said: Mapping[str, Any]) -> Any:
    """The TaskModel of the emulator plug-in of that name with what a scenario says to it, e.g. ``{"reach": "40 cm"}``.

    Raises ValueError with every mistake; PluginError and NoSuchPlugin are such too.
    """
    factory = plugins("opsim.emulators")[name]
    given, complaints = _read(factory, said)
    if complaints:
        raise ValueError("; ".join(" ".join(filter(None, complaint[1:])) for complaint in complaints))
    return factory(**given)


def plugin_problems(name: str, said: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """(key, message, hint) of everything that is wrong with the use of a plug-in; key ``plugin`` for the whole."""
    try:
        _given, complaints = _read(plugins("opsim.emulators")[name], said)
        if not complaints:
            plugin_model(name, said).mean_duration_s()
    except NoSuchPlugin:
        return [(PLUGIN, f"no plug-in {shown(name)}", did_you_mean(name, plugins("opsim.emulators")))]
    except ValueError as error:
        return [(PLUGIN, str(error), "")]
    return complaints


def _read(factory: Any, said: Mapping[str, Any]) -> tuple[dict[str, Any], list[tuple[str, str, str]]]:
    """Numbers by parameter, and the complaints."""
    parameters = {name: p for name, p in inspect.signature(factory).parameters.items() if p.kind in _BY_NAME}
    key_of = {parameter: _key_and_kind(parameter)[0] for parameter in parameters}
    parameter_of = {key: parameter for parameter, key in key_of.items()}
    given: dict[str, Any] = {}
    complaints = [*_unknown(said, parameter_of), *_missing(said, parameters, key_of)]
    for key, value in said.items():
        if key in parameter_of:
            try:
                given[parameter_of[key]] = _value(value, _key_and_kind(parameter_of[key])[1])
            except UnitError as error:
                complaints.append((key, error.message, error.hint))
    return given, complaints


def _unknown(said: Mapping[str, Any], known: Mapping[str, str]) -> Iterator[tuple[str, str, str]]:
    for key in said:
        if key not in known:
            yield key, f"no parameter {shown(key)}", did_you_mean(key, known, otherwise="parameters")


def _missing(said: Mapping[str, Any], parameters: Mapping[str, Any], key_of: Mapping[str, str]) -> Iterator[tuple]:
    for name, parameter in parameters.items():
        if parameter.default is parameter.empty and key_of[name] not in said:
            kind = _key_and_kind(name)[1]
            yield PLUGIN, f"needs {shown(key_of[name])}", f"a {kind}" if kind else ""


def _key_and_kind(parameter: str) -> tuple[str, str]:
    """``reach_m`` -> ("reach", "length"); a name without such an ending stays as it is, with no kind."""
    for ending, kind in KIND_OF_ENDING.items():
        if parameter.endswith(ending) and len(parameter) > len(ending):
            return parameter.removesuffix(ending), kind
    return parameter, ""


def _value(value: Any, kind: str) -> Any:
    return parse(value, kind) if kind else value
