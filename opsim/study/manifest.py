"""What a results folder was made from: versions, seed, hashes. A folder goes on only with a run of the same rows."""

import hashlib
import json
import platform
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any

from opsim import __version__
from opsim.study.resolved import decides_rows

_PACKAGES = ("numpy", "scipy", "numba", "simpy", "pyyaml", "pydantic", "duckdb")
ENGINE = "engine"
"""Which engine was asked for, which was used and why: both give the same rows."""
_NAMES_ONLY = ("scenario", "variant", "file", ENGINE)


def manifest_of(loaded, seed: int) -> dict[str, Any]:
    """Everything that decides the bytes of the events files, and the versions that made them."""
    return {
        "opsim": __version__,
        "scenario": loaded.scenario.name,
        "variant": loaded.variant,
        "file": loaded.file.name,
        "seed": seed,
        "resolved_sha256": _hash(decides_rows(loaded.resolved)),
        "libraries": {
            name: {"file": loaded.scenario.libraries[name], "sha256": _sha256(path)}
            for name, path in library_files(loaded).items()
        },
        "recorded": {name: _sha256(path) for name, path in recorded_files(loaded).items()},
        "plugins": plugins_used(loaded),
        "python": platform.python_version(),
        "packages": {name: version(name) for name in _PACKAGES},
    }


def deciding(manifest: dict[str, Any]) -> dict[str, Any]:
    """The part of a manifest that two runs with the same rows have in common."""
    return {key: value for key, value in manifest.items() if key not in _NAMES_ONLY}


def digest(manifest: dict[str, Any]) -> str:
    """A short name of the run, kept in each of its events files."""
    return _hash(deciding(manifest))[:16]


def library_files(loaded) -> dict[str, Path]:
    """The file of each library, by the name tasks use."""
    from opsim.libraries import resolve_library

    return {name: resolve_library(file, loaded.folder) for name, file in loaded.scenario.libraries.items()}


def recorded_files(loaded) -> dict[str, Path]:
    """The files of recorded times, orders and sequences, by the name that stands in the scenario."""
    from opsim.recorded import resolve_times

    scenario = loaded.scenario
    releases = [*scenario.sources.values(), *([] if scenario.release is None else [scenario.release])]
    names = {name for release in releases for name in (release.file, release.sequence) if isinstance(name, str)}
    names |= set(_recorded(loaded.resolved))
    return {name: resolve_times(name, loaded.folder) for name in sorted(names)}


def _recorded(block: Any) -> Iterator[str]:
    """Every file of recorded times that a scenario names, wherever a time may stand."""
    for key, value in block.items() if isinstance(block, dict) else enumerate(block) if isinstance(block, list) else ():
        if key == "recorded" and isinstance(value, str):
            yield value
        else:
            yield from _recorded(value)


def plugins_used(loaded) -> dict[str, str]:
    """The distribution and version behind each plug-in that the scenario uses, by the plug-in's name."""
    from opsim.plugins import plugins
    from opsim.plugins.door import RULES

    scenario = loaded.scenario
    queues = [scenario.flow.dispatch, *(station.dispatch for station in scenario.stations.values() if station.dispatch)]
    rules = [("opsim.dispatch", scenario.allocation.rule), ("opsim.routing", scenario.flow.routing)]
    rules += [("opsim.sequencing", rule) for rule in queues]
    rules += [("opsim.rotation", rotation.rule) for rotation in scenario.rotations.values()]
    used = {task.plugin: "opsim.emulators" for task in scenario.tasks.values() if hasattr(task, "plugin")}
    used |= {rule: group for group, rule in rules if rule not in RULES[group]}
    return {name: plugins(used[name]).found(name).distribution for name in sorted(used)}


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
