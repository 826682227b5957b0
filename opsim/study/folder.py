"""A results folder: what it holds, whether a run may go on in it, and how it is made ready."""

import json
import shutil
from pathlib import Path
from typing import Any

from opsim.engine.choice import REFERENCE, SIMPY, Choice
from opsim.results import events_in
from opsim.study.finished import FINISHED
from opsim.study.manifest import ENGINE, deciding, library_files, manifest_of, recorded_files
from opsim.study.resolved import decides_figures, differences, read_resolved, resolved_text, with_run
from opsim.whole import whole_file, write_json, write_text

MANIFEST, RESOLVED = "manifest.json", "scenario.resolved.yaml"
LOCK = ".run.lock"
RESULTS = (FINISHED, "summary.json", "kpis.parquet", "report.html", "replay.html", "postures.json")
MOST_DIFFERENCES = 5


class OtherRun(ValueError):
    """The folder holds finished work of another run, which is not deleted unasked."""


def open_folder(folder: Path, loaded, seed: int, replications: int, *, overwrite: bool = False) -> dict[str, Any]:
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
    _remove(folder, RESULTS)


def say_replications(folder: Path, loaded, seed: int, replications: int) -> None:
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


def other_run(folder: Path, loaded, seed: int) -> str | None:
    """What the folder holds and in what it differs from this run, in words; None where the run may go on there."""
    n = len(events_in(folder))
    if not n and not any((folder / name).exists() for name in RESULTS):
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


def _copy_inputs(folder: Path, loaded) -> None:
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
