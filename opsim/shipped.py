"""The scenarios and motion libraries that come with opsim."""

from __future__ import annotations

from pathlib import Path

from opsim.names import natural_key
from opsim.problems import Problem, ScenarioError, did_you_mean


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
    shipped = [f"{known}{file.suffix}" for known in shipped_scenarios()]
    hint = did_you_mean(file.name, [*beside, *shipped], otherwise="known scenarios")
    raise ScenarioError([Problem(str(path), 0, 0, "", "no such file, and no shipped scenario of that name", hint)])
