"""One writer at a time: a lock that ends with the process that holds it, however that ends.

What a results folder was made from: versions, seed, hashes. A folder goes on only with a run of the same rows.

Results that are there of just the run that is asked for: taken as they are, and no row is read again.

A results folder: what it holds, whether a run may go on in it, and how it is made ready.
"""

from __future__ import annotations

import hashlib
import json
import platform
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from opsim import __version__
from opsim.engine import SIMPY
from opsim.engine.choice import REFERENCE, Choice
from opsim.files import whole_file, write_json, write_text
from opsim.results import events_in
from opsim.study.resolved_scenario import (
    STUDIES,
    decides_figures,
    decides_rows,
    differences,
    read_resolved,
    resolved_text,
    with_run,
)

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


class Busy(ValueError):
    """Somebody else writes there now."""


@contextmanager
def locked(path: Path, words: str, wait_s: float = 0.0) -> Iterator[None]:
    """Hold the lock file ``path`` while the block runs; the operating system lets it go when a process is killed.

    words : what is said where another process holds it. wait_s : for so long it is waited for
    Raises Busy, OSError.
    """
    from filelock import FileLock, Timeout

    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path)
    try:
        lock.acquire(timeout=wait_s)
    except Timeout:
        raise Busy(words) from None
    try:
        yield
    finally:
        lock.release()


_PACKAGES = ("numpy", "scipy", "numba", "simpy", "pyyaml", "pydantic", "duckdb")
ENGINE = "engine"
"""Which engine was asked for, which was used and why: both give the same rows."""
_NAMES_ONLY = ("scenario", "variant", "file", ENGINE)


def manifest_of(loaded: Loaded, seed: int) -> dict[str, Any]:
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


def library_files(loaded: Loaded) -> dict[str, Path]:
    """The file of each library, by the name tasks use."""
    from opsim.libraries import resolve_library

    return {name: resolve_library(file, loaded.folder) for name, file in loaded.scenario.libraries.items()}


def recorded_files(loaded: Loaded) -> dict[str, Path]:
    """The files of recorded times, orders and sequences, by the name that stands in the scenario."""
    from opsim.csv_input import resolve_times

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


def plugins_used(loaded: Loaded) -> dict[str, str]:
    """The distribution and version behind each plug-in that the scenario uses, by the plug-in's name."""
    from opsim.plugins import plugins
    from opsim.plugins.registry import RULES
    from opsim.scenario.schema.subjects import subjects_said

    scenario = loaded.scenario
    queues = [scenario.flow.dispatch, *(station.dispatch for station in scenario.stations.values() if station.dispatch)]
    rules = [("opsim.dispatch", scenario.allocation.rule), ("opsim.routing", scenario.flow.routing)]
    rules += [("opsim.sequencing", rule) for rule in queues]
    rules += [("opsim.rotation", rotation.rule) for rotation in scenario.rotations.values()]
    used = {task.plugin: "opsim.emulators" for task in scenario.tasks.values() if hasattr(task, "plugin")}
    used |= {rule: group for group, rule in rules if rule not in RULES[group]}
    used |= {key: "opsim.subjects" for key, *_ in subjects_said(scenario)}
    return {name: plugins(used[name]).found(name).distribution for name in sorted(used)}


def _hash(value: Any) -> str:
    return hashlib.sha256(json.dumps(value, sort_keys=True).encode()).hexdigest()


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


FINISHED = "finished.json"
RESULTS = ("summary.json", "kpis.parquet")


def finished(folder: Path, loaded: Loaded, manifest: dict[str, Any], asks: dict[str, Any]) -> bool:
    """Whether the folder holds the whole results of this run.

    asks : what the run was given beside its scenario file
    True where summary and figures are as they were written, and of each replication there are rows of the same length.
    """
    try:
        held = json.loads((folder / FINISHED).read_text(encoding="utf-8"))
        return held == _says(folder, loaded, manifest, asks, held["events"])
    except (OSError, ValueError, TypeError, KeyError):
        return False


def say_finished(
    folder: Path, loaded: Loaded, manifest: dict[str, Any], asks: dict[str, Any], replications: int
) -> None:
    """Write of what run the results are; last of all, so that where it is there, the others are. Raises OSError."""
    events = [path.name for path in events_in(folder)[:replications]]
    write_json(folder / FINISHED, _says(folder, loaded, manifest, asks, events))


def _says(folder: Path, loaded: Loaded, manifest: dict[str, Any], asks: dict[str, Any], events: Any) -> dict[str, Any]:
    made_from = [manifest, {key: block for key, block in loaded.resolved.items() if key != STUDIES}]
    return {
        "run": _sha256_of(json.dumps([*made_from, sorted(loaded.given), asks]).encode()),
        "results": {name: _sha256_of((folder / name).read_bytes()) for name in RESULTS},
        "events": {name: (folder / "events" / name).stat().st_size for name in events},
    }


def _sha256_of(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


MANIFEST, RESOLVED = "manifest.json", "scenario.resolved.yaml"
LOCK = ".run.lock"
RESULT_FILES = (FINISHED, "summary.json", "kpis.parquet", "report.html", "replay.html", "postures.json")
MOST_DIFFERENCES = 5


class OtherRun(ValueError):
    """The folder holds finished work of another run, which is not deleted unasked."""


def open_folder(
    folder: Path, loaded: Loaded, seed: int, replications: int, *, overwrite: bool = False
) -> dict[str, Any]:
    """Make a folder ready for a run and return the run's manifest.

    Finished replications of the same rows stay. overwrite : what the folder holds is removed first.
    Raises OtherRun, OSError.
    """
    manifest = manifest_of(loaded, seed)
    if overwrite:
        _empty(folder)
    elif (words := other_run(folder, loaded, seed)) is not None:
        raise OtherRun(words)
    held, before = _read_resolved(folder), _read_manifest(folder)
    made_by = {key: before.pop(key) for key in (ENGINE,) if key in before}
    if before != manifest or not held or decides_figures(held) != decides_figures(loaded.resolved):
        clear_results(folder)
    _copy_inputs(folder, loaded)
    say_replications(folder, loaded, seed, replications)
    write_json(folder / MANIFEST, manifest | (made_by if events_in(folder) else {}))
    return manifest


def clear_results(folder: Path) -> None:
    """Remove what was made of rows, which stay. Raises OSError."""
    _remove(folder, RESULT_FILES)


def say_replications(folder: Path, loaded: Loaded, seed: int, replications: int) -> None:
    """Write the resolved scenario, with the seed and the number of replications that are used."""
    write_text(folder / RESOLVED, resolved_text(with_run(loaded.resolved, seed, replications)))


def say_engine(folder: Path, choice: Choice) -> None:
    """Write which engine makes the rows that are not there yet, beside those that made the others. Raises OSError."""
    manifest = _read_manifest(folder)
    held = engine_said(folder)
    others = {*held.get("earlier", ()), held.get("used", SIMPY)} - {choice.engine} if events_in(folder) else ()
    earlier = {"earlier": sorted(others)} if others else {}
    said = {"asked": choice.asked, "used": choice.engine, "why": choice.why}
    write_json(folder / MANIFEST, manifest | {ENGINE: said | earlier})


def engine_said(folder: Path) -> dict[str, Any]:
    """What the manifest says of engines; of an older folder, that SimPy was used. Raises nothing."""
    held = _read_manifest(folder).get(ENGINE)
    return held if isinstance(held, dict) else {"asked": SIMPY, "used": SIMPY, "why": REFERENCE.why}


def other_run(folder: Path, loaded: Loaded, seed: int) -> str | None:
    """What the folder holds and in what it differs from this run, in words; None where the run may go on there."""
    n = len(events_in(folder))
    if not n and not any((folder / name).exists() for name in RESULT_FILES):
        return None
    manifest, held = manifest_of(loaded, seed), _read_manifest(folder)
    if deciding(held) == deciding(manifest):
        return None
    differ = _differences(folder, held, manifest, loaded.resolved)
    more = f" and {len(differ) - MOST_DIFFERENCES} more" if len(differ) > MOST_DIFFERENCES else ""
    return f"{folder} holds {_held_words(held, n)}; not the same: {'; '.join(differ[:MOST_DIFFERENCES])}{more}"


def _held_words(held: dict[str, Any], n: int) -> str:
    count = "1 replication" if n == 1 else f"{n} replications"
    if not held:
        return f"{count} of a run that is not known (its {MANIFEST} cannot be read)"
    return f"{count} of {held.get('scenario', '')!r}, variant {held.get('variant', '')}, seed {held.get('seed', '')}"


def _differences(folder: Path, held: dict[str, Any], manifest: dict[str, Any], resolved: dict[str, Any]) -> list[str]:
    if not held:
        return [MANIFEST]
    words = []
    if held.get("seed") != manifest["seed"]:
        words.append(f"seed {held.get('seed')}, now {manifest['seed']}")
    if held.get("resolved_sha256") != manifest["resolved_sha256"]:
        words += differences(_read_resolved(folder), resolved) or ["the scenario"]
    for kind, what in (("libraries", "the library"), ("recorded", "the file")):
        old, new = held.get(kind) or {}, manifest[kind]
        words += [f"{what} {name} has changed" for name in {**old, **new} if old.get(name) != new.get(name)]
    old, new = ({"opsim": m.get("opsim"), "python": m.get("python"), **m.get("packages", {})} for m in (held, manifest))
    words += [f"{name} {old.get(name)}, now {new.get(name)}" for name in {**old, **new} if old.get(name) != new[name]]
    return words


def _copy_inputs(folder: Path, loaded: Loaded) -> None:
    """A user's own libraries and recorded times go along, so that the resolved scenario runs from the folder."""
    from opsim.shipped import shipped_folder

    libraries = {loaded.scenario.libraries[name]: path for name, path in library_files(loaded).items()}
    for name, path in {**libraries, **recorded_files(loaded)}.items():
        copy = folder / name
        if path.is_relative_to(shipped_folder()) or (copy.exists() and copy.read_bytes() == path.read_bytes()):
            continue
        with whole_file(copy) as temporary:
            shutil.copyfile(path, temporary)


def _empty(folder: Path) -> None:
    """Remove results first, then rows: what is left half-way is never a summary without its rows."""
    clear_results(folder)
    for stale in [*events_in(folder), *(folder / "events").glob(".replication_*.part")]:
        stale.unlink(missing_ok=True)


def _remove(folder: Path, names: tuple[str, ...]) -> None:
    for name in names:
        (folder / name).unlink(missing_ok=True)


def _read_resolved(folder: Path) -> dict[str, Any]:
    try:
        return read_resolved((folder / RESOLVED).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}


def _read_manifest(folder: Path) -> dict[str, Any]:
    try:
        held = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return held if isinstance(held, dict) else {}
