"""Finds where a fault goes, plants it in a copy of the project, and runs tests there."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

from mutants.faults import Fault

ROOT = Path(__file__).parents[2]
COPIED = ("opsim", "emulator", "tests", "scenarios", "examples")
PACKAGES = ("opsim", "emulator")


def place_of(fault: Fault, root: Path = ROOT) -> Path:
    """The module with the function that says the fault's words once. Raises ValueError unless it is one."""
    found = [path for path, text in _sources(root) if _planted(fault, text) is not None]
    if len(found) != 1:
        raise ValueError(f"{fault.name}: found in {[str(path) for path in found]}, expected one place")
    return found[0]


def catchers_of(fault: Fault, root: Path = ROOT) -> list[str]:
    """The tests that see it, as pytest names them. Raises ValueError for one that is nowhere, or twice."""
    names = []
    for name in fault.caught_by:
        found = [path for path, text in _tests(root) if re.search(rf"^def {name}\(", text, re.M)]
        if len(found) != 1:
            raise ValueError(f"{fault.name}: test {name} found in {[str(path) for path in found]}, expected one file")
        names.append(f"{found[0].relative_to(root).as_posix()}::{name}")
    return names


def copy_to(folder: Path) -> Path:
    """The project's files, compiled ones with them, in a folder of their own."""
    for name in COPIED:
        shutil.copytree(ROOT / name, folder / name, symlinks=True, ignore=shutil.ignore_patterns("node_modules"))
    shutil.copy2(ROOT / "pyproject.toml", folder)
    return folder


def is_caught(fault: Fault, copy: Path) -> bool:
    """Whether the tests named fail in the copy while the fault is in it; they are those that ``make test`` runs."""
    path = place_of(fault, copy)
    sound = path.read_text(encoding="utf-8")
    path.write_text(_planted(fault, sound) or "", encoding="utf-8")
    try:
        return failing(copy, catchers_of(fault, copy))
    finally:
        path.write_text(sound, encoding="utf-8")


def failing(copy: Path, tests: list[str]) -> bool:
    """Whether a test fails there. Raises ValueError where they do not run at all."""
    environment = os.environ | {"PYTHONPATH": f"{copy}{os.pathsep}{copy / 'tests'}"}
    environment = {name: value for name, value in environment.items() if not name.startswith("PYTEST_")}
    words = ["-m", "pytest", "-p", "no:xdist", "-p", "no:cacheprovider", "-x", "-q", "-m", "not slow and not browser"]
    done = subprocess.run([sys.executable, *words, *tests], cwd=copy, env=environment, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise ValueError(f"{' '.join(tests)}: {done.stdout[-1500:]}{done.stderr[-500:]}")
    return done.returncode == 1


def _planted(fault: Fault, text: str) -> str | None:
    """The module with the fault in it; None where the function is not there, or does not say the words once."""
    if f"def {fault.function}(" not in text or fault.old not in text:
        return None
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef) and node.name == fault.function:
            lines = text.splitlines(keepends=True)
            start, end = node.lineno - 1, node.end_lineno or node.lineno
            own = "".join(lines[start:end])
            if own.count(fault.old) == 1:
                return "".join(lines[:start]) + own.replace(fault.old, fault.new) + "".join(lines[end:])
    return None


def _sources(root: Path) -> list[tuple[Path, str]]:
    return [(path, _text(path)) for package in PACKAGES for path in sorted((root / package).rglob("*.py"))]


@cache
def _tests(root: Path) -> list[tuple[Path, str]]:
    return [(path, path.read_text(encoding="utf-8")) for path in sorted((root / "tests").rglob("test_*.py"))]


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")
