"""What a results folder was made from: versions, seed, hashes. A folder goes on only with the same manifest."""

import hashlib
import json
import platform
from importlib.metadata import version
from pathlib import Path

from opsim import __version__
from opsim.plan import Plan
from opsim.whole import write_json, write_text

_PACKAGES = ("numpy", "scipy", "numba", "simpy", "pyyaml", "pydantic", "duckdb")


def manifest_of(loaded, plan: Plan) -> dict:
    """Everything that decides the bytes of the events files, and the versions that made them."""
    from opsim.libraries import resolve_library

    libraries = {name: resolve_library(file, loaded.folder) for name, file in loaded.scenario.libraries.items()}
    return {
        "opsim": __version__,
        "scenario": plan.name,
        "variant": loaded.variant,
        "file": loaded.file.name,
        "seed": plan.seed,
        "resolved_sha256": hashlib.sha256(resolved_text(loaded).encode()).hexdigest(),
        "libraries": {
            name: {"file": loaded.scenario.libraries[name], "sha256": _sha256(path)} for name, path in libraries.items()
        },
        "recorded": _recorded(loaded),
        "python": platform.python_version(),
        "packages": {name: version(name) for name in _PACKAGES},
    }


def open_folder(folder: Path, loaded, manifest: dict) -> None:
    """Write scenario and manifest; events of another manifest are removed first, as they would not belong together."""
    path = folder / "manifest.json"
    if not _same(path, manifest):
        for stale in (folder / "events").glob("replication_*.parquet"):
            stale.unlink()
    write_text(folder / "scenario.resolved.yaml", resolved_text(loaded))
    write_json(path, manifest)


def resolved_text(loaded) -> str:
    """The variant as one plain YAML file: ``like`` and overrides applied, units kept."""
    import yaml

    return yaml.safe_dump(loaded.resolved, sort_keys=False, allow_unicode=True, default_flow_style=None, width=100)


def _same(path: Path, manifest: dict) -> bool:
    try:
        return json.loads(path.read_text(encoding="utf-8")) == manifest
    except (OSError, ValueError):
        return False


def _recorded(loaded) -> dict[str, str]:
    from opsim.recorded import resolve_times

    files = {task.recorded for task in loaded.scenario.tasks.values() if hasattr(task, "recorded")}
    return {file: _sha256(resolve_times(file, loaded.folder)) for file in sorted(files)}


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
