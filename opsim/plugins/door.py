"""The door by which parts come in: entry points by group and name, ours as anybody's."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib.metadata import entry_points
from typing import Any

from opsim.engine.rules import ALLOCATION_RULES, ROTATION_RULES, ROUTING_RULES, SEQUENCING_RULES
from opsim.names import natural_key
from opsim.plugins.blame import Found, NoSuchPlugin, PluginError, blamed
from opsim.plugins.guard import GUARDS
from opsim.problems import did_you_mean, shown

GROUPS = (
    *("opsim.emulators", "opsim.stations", "opsim.dispatch", "opsim.sequencing", "opsim.routing", "opsim.rotation"),
    "opsim.human",
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
