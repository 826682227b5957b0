"""A variant as one plain YAML file, ``like`` and overrides applied, and in what two of them differ."""

from collections.abc import Iterator
from typing import Any

NOT_IN_ROWS = ("name", "outputs", "frontier", "run.posture", "run.seed", "run.replications", "run.warm_up")
"""What two runs may differ in and still have the same rows; of these the manifest names the seed by itself."""


def resolved_text(resolved: dict[str, Any]) -> str:
    """The file's text: units kept, and every text quoted that would not be read back as the same text."""
    import yaml

    return yaml.dump(
        resolved, Dumper=_dumper(), sort_keys=False, allow_unicode=True, default_flow_style=None, width=100
    )


def with_run(resolved: dict[str, Any], seed: int, replications: int) -> dict[str, Any]:
    """The variant with the seed and the number of replications that were used, wherever they came from."""
    return {**resolved, "run": {**resolved["run"], "replications": replications, "seed": seed}}


def decides_rows(resolved: dict[str, Any]) -> dict[str, Any]:
    """Dotted path -> value of all that a replication's rows depend on (beside the seed)."""
    return {path: value for path, value in _leaves(resolved, ()) if path not in NOT_IN_ROWS}


def differences(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """In words, path by path, what decides rows and is not the same in two resolved scenarios."""
    old, new = decides_rows(before), decides_rows(now)
    paths = [path for path in {**old, **new} if old.get(path) != new.get(path)]
    return [f"{path} {_shown(old, path)}, now {_shown(new, path)}" for path in paths]


def read_resolved(text: str) -> dict[str, Any]:
    """The plain values of a resolved file; empty where it cannot be read."""
    from opsim.problems import ScenarioError
    from opsim.scenario.yaml_nodes import read_tree

    try:
        plain = read_tree(text.encode(), "scenario.resolved.yaml")[0].plain()
    except ScenarioError:
        return {}
    return plain if isinstance(plain, dict) else {}


def _leaves(value: Any, path: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for key, below in value.items():
            yield from _leaves(below, (*path, str(key)))
    else:
        yield ".".join(path), value


def _shown(values: dict[str, Any], path: str) -> str:
    if path not in values:
        return "not there"
    text = str(values[path])
    return text if len(text) <= 40 else text[:37] + "..."


def _dumper() -> Any:
    import yaml

    from opsim.scenario.yaml_nodes import scalar

    class Dumper(yaml.SafeDumper):
        """Writes plain only what opsim's reader (YAML 1.2) gives back as the same text; never an alias."""

        def ignore_aliases(self, data: Any) -> bool:
            return True

    def text(dumper: Any, value: str) -> Any:
        style = "'" if not isinstance(scalar(value), str) else None if value.isprintable() else '"'
        return dumper.represent_scalar("tag:yaml.org,2002:str", value, style=style)

    Dumper.add_representer(str, text)
    return Dumper
