"""A variant as one plain YAML file, ``like`` and overrides applied, and in what two of them differ."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from opsim.engine.rules import LEAST_EXPOSED

TreePath = tuple[str, ...]
IN_NOTHING = (("name",), ("run", "seed"), ("run", "replications"))
IN_FIGURES = (("outputs",), ("frontier",), ("run", "posture"), ("run", "warm_up"))
"""What two runs may differ in and still have the same rows, without and with other figures; the manifest names the seed
by itself."""
STUDIES = "studies"
"""What is asked of a scenario, which decides nothing of it."""
SCORES, LOADS = "ergonomics", ("load", "loaded", "handling")
"""How postures are scored, and what a task says of hands and bodies: these decide rows only where something asks."""


def resolved_text(resolved: dict[str, Any]) -> str:
    """The file's text: units kept, and every text quoted that would not be read back as the same text."""
    import yaml

    return yaml.dump(
        resolved, Dumper=_dumper(), sort_keys=False, allow_unicode=True, default_flow_style=None, width=100
    )


def with_run(resolved: dict[str, Any], seed: int, replications: int) -> dict[str, Any]:
    """The variant with the seed and the number of replications that were used, wherever they came from."""
    return {**resolved, "run": {**resolved["run"], "replications": replications, "seed": seed}}


def decides_rows(resolved: dict[str, Any], asked: frozenset[str] | None = None) -> dict[str, Any]:
    """Dotted path -> value of all that a replication's rows depend on (beside the seed).

    asked : what of SCORES and LOADS they depend on; None: as ``asked_by`` finds
    """
    asked = asked_by(resolved) if asked is None else asked
    floor = {section: block for section, block in resolved.items() if section != STUDIES}
    leaves = ((path, value) for path, value in _leaves(floor, ()) if path not in IN_NOTHING)
    return {".".join(path): value for path, value in leaves if not _in_figures_only(path, asked)}


def decides_figures(resolved: dict[str, Any]) -> dict[str, Any]:
    """Dotted path -> value of what figures depend on and rows do not: these are made anew of the same rows."""
    asked = asked_by(resolved)
    return {".".join(path): value for path, value in _leaves(resolved, ()) if _in_figures_only(path, asked)}


def asked_by(resolved: dict[str, Any]) -> frozenset[str]:
    """What of SCORES and LOADS decides who does what when: all, where a rule evens out exposure; loads, where fatigue
    comes from the postures, as it does in every model but lffrm of even work.
    """
    rotations = resolved.get("rotations")
    rules = [_at(resolved, "allocation", "rule")]
    rules += [_at(one, "rule") for one in rotations.values()] if isinstance(rotations, dict) else []
    if LEAST_EXPOSED in rules:
        return frozenset((SCORES, *LOADS))
    fatigue = _at(resolved, "human", "fatigue")
    even = _at(fatigue, "model") == "lffrm" and _at(fatigue, "by") in (None, "even")
    return frozenset() if fatigue is None or even else frozenset(LOADS)


def differences(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """In words, path by path, what decides rows and is not the same in two resolved scenarios."""
    asked = asked_by(before) | asked_by(now)
    old, new = decides_rows(before, asked), decides_rows(now, asked)
    paths = [path for path in {**old, **new} if old.get(path) != new.get(path)]
    return [f"{path} {_shown(old, path)}, now {_shown(new, path)}" for path in paths]


def read_resolved(text: str) -> dict[str, Any]:
    """The plain values of a resolved file; empty where it cannot be read."""
    from opsim.problems import ScenarioError
    from opsim.scenario.yaml import read_tree

    try:
        plain = read_tree(text.encode(), "scenario.resolved.yaml")[0].plain()
    except ScenarioError:
        return {}
    return plain if isinstance(plain, dict) else {}


def _in_figures_only(path: TreePath, asked: frozenset[str]) -> bool:
    hand = path[2] if path[0] == "tasks" and len(path) > 2 else ""
    kind = SCORES if path[0] == SCORES else hand if hand in LOADS else ""
    return path in IN_FIGURES or (bool(kind) and kind not in asked)


def _at(block: Any, *path: str) -> Any:
    """What stands there; None where nothing does."""
    for key in path:
        block = block.get(key) if isinstance(block, dict) else None
    return block


def _leaves(value: Any, path: TreePath) -> Iterator[tuple[TreePath, Any]]:
    if isinstance(value, dict) and value:
        for key, below in value.items():
            yield from _leaves(below, (*path, str(key)))
    else:
        yield path, value


def _shown(values: dict[str, Any], path: str) -> str:
    if path not in values:
        return "not there"
    text = str(values[path])
    return text if len(text) <= 40 else text[:37] + "..."


def _dumper() -> Any:
    import yaml

    from opsim.scenario.yaml import scalar

    class Dumper(yaml.SafeDumper):
        """Writes plain only what opsim's reader (YAML 1.2) gives back as the same text; never an alias."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    def text(dumper: Any, value: str) -> Any:
        style = "'" if not isinstance(scalar(value), str) else None if value.isprintable() else '"'
        return dumper.represent_scalar("tag:yaml.org,2002:str", value, style=style)

    Dumper.add_representer(str, text)
    return Dumper
