"""Files that a scenario names lie in its folder, or in the shipped one, never elsewhere."""

from __future__ import annotations

from pathlib import Path, PurePosixPath, PureWindowsPath


class NotInside(ValueError):
    """A path that leads out of the scenario's folder."""


def inside(name: str, *folders: Path) -> Path | None:
    """The file of that name in the first folder that has it, or None. Raises NotInside for a path that leads out."""
    path = PurePosixPath(name)
    if not name.strip() or "\0" in name or len(name) > 500:
        raise NotInside("this cannot be a file name")
    if path.is_absolute() or PureWindowsPath(name).anchor or ".." in PureWindowsPath(name).parts:
        raise NotInside("the file must lie in the scenario's folder or below it")
    return next((folder / path for folder in folders if (folder / path).is_file()), None)
