"""Is everything here that opsim needs? Each question is answered by a finding; nothing is changed."""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

OK, NOTE, WRONG = "ok", "note", "wrong"
OLDEST_PYTHON = (3, 11)
_REQUIREMENT = re.compile(r"^([A-Za-z0-9._-]+)(?:>=([0-9.]+))?$")


@dataclass(frozen=True, slots=True)
class Finding:
    """What was looked at, its state (ok, note: worth knowing; wrong: opsim cannot do its work), and what was found."""

    what: str
    state: str
    said: str


def findings() -> list[Finding]:
    """All findings, what opsim stands on first."""
    questions: tuple[Callable[[], Iterator[Finding]], ...] = (
        *(_python, _packages, _scenarios, _libraries),
        *(_compiled_code, _fast_engine, _processes, _folder, _words, _browser),
    )
    return [finding for question in questions for finding in question()]


def _python() -> Iterator[Finding]:
    version = ".".join(map(str, sys.version_info[:3]))
    good = sys.version_info[:2] >= OLDEST_PYTHON
    yield Finding("Python", OK if good else WRONG, version if good else f"{version}; 3.11 or newer is needed")


def _packages() -> Iterator[Finding]:
    """Every package that opsim requires: there, and new enough."""
    for requirement in metadata.requires("opsim") or ():
        match = _REQUIREMENT.match(requirement.replace(" ", ""))
        if match is None:  # of an extra, such as those for development
            continue
        name, oldest = match[1], match[2] or "0"
        try:
            found = metadata.version(name)
        except metadata.PackageNotFoundError:
            yield Finding(name, WRONG, f"not installed; pip install '{requirement}'")
            continue
        new_enough = _numbers(found) >= _numbers(oldest)
        yield Finding(name, OK if new_enough else WRONG, found if new_enough else f"{found}; {oldest} is needed")


def _numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in re.findall(r"[0-9]+", version)[:3])


def _scenarios() -> Iterator[Finding]:
    from opsim.problems import ScenarioError
    from opsim.scenario import read_scenarios
    from opsim.shipped import shipped_folder, shipped_scenarios

    names = shipped_scenarios()
    wrong = []
    for name in names:
        try:
            read_scenarios(shipped_folder() / f"{name}.yaml")
        except ScenarioError as error:
            wrong.append(f"{name}: {error.problems[0].message}")
    if wrong or not names:
        yield Finding("shipped scenarios", WRONG, "; ".join(wrong) or f"none in {shipped_folder()}; install opsim anew")
    else:
        yield Finding("shipped scenarios", OK, ", ".join(names))


def _libraries() -> Iterator[Finding]:
    from opsim.libraries import LibraryMissing, library_tasks
    from opsim.shipped import shipped_folder

    files = sorted((shipped_folder() / "libraries").glob("*.npz"))
    try:
        said = ", ".join(f"{file.name} ({len(library_tasks(file))} tasks)" for file in files)
        yield Finding("motion libraries", OK if files else WRONG, said or "none found; install opsim anew")
    except LibraryMissing as error:
        yield Finding("motion libraries", WRONG, error.message)


def _compiled_code() -> Iterator[Finding]:
    """Where numba may keep what it compiled; without such a place every process compiles anew."""
    here = Path(__file__).resolve().parent
    places = [_place_of(folder) for folder in (here.parent / "emulator" / "kernels", here / "engine" / "fast_engine")]
    if None in places:
        yield Finding("compiled code", NOTE, "can be kept nowhere: each process compiles anew; set NUMBA_CACHE_DIR")
    else:
        kept = f"is kept in {' and '.join(map(str, dict.fromkeys(places)))}"
        named = os.environ.get("NUMBA_CACHE_DIR")
        if named and Path(named) not in places:
            yield Finding("compiled code", NOTE, f"{kept}, as NUMBA_CACHE_DIR cannot be written: {named}")
        else:
            yield Finding("compiled code", OK, kept)


def _fast_engine() -> Iterator[Finding]:
    """How much of the fast engine is compiled, of these sources and by this numba."""
    from numba import config

    from opsim.engine.fast_engine.machine.code_cache import folder, kept, shipped

    where = folder()
    if getattr(config, "DISABLE_JIT", 0):
        yield Finding("fast engine", NOTE, "off, as NUMBA_DISABLE_JIT is set: --engine auto takes SimPy")
    elif where is None:
        yield Finding("fast engine", NOTE, "compiled anew by each command, as it can be kept nowhere")
    else:
        n_steps = len({line for code in kept() for line in code.steps})
        said = f"{n_steps} of its steps are compiled" if n_steps else "compiled when it is first used"
        places = " and ".join(str(one) for one in (shipped(), where) if one is not None)
        yield Finding("fast engine", OK, f"{said}, in {places}")


def _place_of(beside: Path) -> Path | None:
    """Where numba keeps what it compiles of the files in a folder."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return next((folder for folder in (Path(named) if named else beside, beside, home) if _writable(folder)), None)


def _writable(folder: Path) -> bool:
    """Whether files can be made in a folder, or the folder itself in the nearest one above that is there."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return folder.is_dir() and os.access(folder, os.W_OK | os.X_OK)


def _processes() -> Iterator[Finding]:
    n_cores = os.cpu_count() or 1
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else n_cores
    yield Finding("processes", OK, f"{allowed} of {n_cores} cores may be used")


def _folder() -> Iterator[Finding]:
    here = Path.cwd()
    free_gb = shutil.disk_usage(here).free / 1e9
    if not _writable(here):
        yield Finding("this folder", NOTE, "cannot be written; name another for results with -o")
    else:
        yield Finding("this folder", OK if free_gb > 1 else NOTE, f"can be written, {free_gb:.0f} GB free")


def _words() -> Iterator[Finding]:
    encoding = (getattr(sys.stdout, "encoding", None) or "unknown").lower()
    good = encoding.replace("-", "") == "utf8"
    yield Finding("output", OK if good else NOTE, encoding if good else f"{encoding}; set PYTHONUTF8=1 for ± and –")


def _browser() -> Iterator[Finding]:
    yield Finding("browser", OK, "not needed to run; reports are single files that any browser opens, offline")
