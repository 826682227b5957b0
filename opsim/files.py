"""Files that a scenario names lie in its folder, or in the shipped one, never elsewhere.

Files that are either whole or not there: written under a temporary name, flushed to the disk, then renamed.
"""

from __future__ import annotations

import errno
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any


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


_unfinished: set[Path] = set()


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A temporary path beside ``path``; it takes the final name when the block ends well, else it is removed.

    Raises OSError that names ``path``, never the temporary file.
    """
    if not path.name:
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    _unfinished.add(temporary)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield temporary
        _flushed(temporary, os.O_RDWR)
        os.replace(temporary, path)
        if os.name == "posix":  # so that the new name, too, outlives a power cut
            _flushed(path.parent, os.O_RDONLY)
    except OSError as error:
        if error.errno is None or error.filename not in (None, str(temporary), temporary):
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)
        _unfinished.discard(temporary)


def remove_unfinished() -> None:
    """Remove what this process has begun to write and not finished, where it must end at once."""
    for temporary in tuple(_unfinished):
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 text whole."""
    with whole_file(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: Path, value: Any) -> None:
    """Write JSON whole; keys in the order given; what is not a finite number is null in the file."""
    import json

    write_text(path, json.dumps(_without_nan(value), indent=1, ensure_ascii=False, allow_nan=False) + "\n")


def _flushed(path: Path, flags: int) -> None:
    opened = os.open(path, flags)
    try:
        os.fsync(opened)
    finally:
        os.close(opened)


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
