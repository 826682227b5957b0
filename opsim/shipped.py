"""The scenarios and motion libraries that come with opsim."""

from __future__ import annotations

from pathlib import Path

from opsim.problems import Problem, ScenarioError, natural_key, nearest_file, shown

FEW = 5


def shipped_folder() -> Path:
    """The folder of shipped scenarios: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).resolve().parent
    installed = package / "scenarios"
    return installed if installed.is_dir() else package.parent / "scenarios"


def shipped_scenarios() -> list[str]:
    """The names of the shipped scenarios, without ``.yaml``."""
    return sorted((path.stem for path in shipped_folder().glob("*.yaml")), key=natural_key)


def find_scenario(path: str | Path) -> Path:
    """The file at a path or, where there is none, the shipped scenario of that name. Raises ScenarioError."""
    file = Path(path)
    if "\0" not in str(path) and file.exists():
        return file
    name = file.name.removesuffix(".yaml")
    if name in shipped_scenarios() and str(path) in (name, f"{name}.yaml", f"scenarios/{name}.yaml"):
        return shipped_folder() / f"{name}.yaml"
    beside = (
        [other.name for other in file.parent.glob("*.y*ml")] if "\0" not in str(path) and file.parent.is_dir() else []
    )
    hint = _meant(file, beside)
    raise ScenarioError([Problem(str(path), 0, 0, "", "no such file, and no shipped scenario of that name", hint)])


def _meant(file: Path, beside: list[str]) -> str:
    """The nearest file beside it or shipped scenario, compared without ``.yaml``; else where to find one.

    beside : names of the scenarios in its folder
    """
    near = nearest_file(file, [*beside, *(f"{name}{file.suffix}" for name in shipped_scenarios())])
    if near is not None:
        return f"did you mean {shown(near)}?"
    here = f"here are {', '.join(sorted(beside)[:FEW])}{', ...' if len(beside) > FEW else ''}; " if beside else ""
    return f"{here}'opsim init --list' shows those that come with opsim"
