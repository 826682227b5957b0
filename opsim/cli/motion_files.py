"""Files that ``opsim motion`` reads and writes: libraries found by path or shipped name, outputs tried beforehand."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def chosen(library: str, task: str | None) -> Any:
    """The emulator of a task of a library file, or of a shipped library by its name. Raises ValueError."""
    from opsim.libraries import load_library

    loaded = load_library(_found(library))
    return loaded.only() if task is None else loaded[task]


def _found(library: str) -> Path:
    from opsim.problems import did_you_mean, shown
    from opsim.shipped import shipped_folder

    file, folder = Path(library), shipped_folder() / "libraries"
    shipped = {path.stem: path for path in folder.glob("*.npz")}
    if "\0" not in library and file.is_file():
        return file
    name = library.removesuffix(".npz")
    if name in shipped:
        return shipped[name]
    beside = [] if "\0" in library else [str(path) for path in file.parent.glob("*.npz") if path.is_file()]
    hint = did_you_mean(library, [*beside, *shipped], otherwise="libraries here and shipped ones")
    raise ValueError(f"no library {shown(library)}; {hint}")


def ready(out: Path, *endings: str) -> Path:
    """``out``, after its folder is made and was written to: better now than after the work. Raises ValueError."""
    import tempfile

    if out.suffix.lower() not in endings:
        raise ValueError(f"{out}: found the ending {out.suffix!r}, expected {' or '.join(endings)}")
    if out.is_dir():
        raise ValueError(f"{out}: found a folder, expected the name of a file to write")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out.parent):
            pass
    except (FileExistsError, NotADirectoryError):
        raise ValueError(f"{out}: cannot be written: {out.parent} is, or lies in, a file, not a folder") from None
    except OSError as error:
        raise ValueError(f"{out}: cannot be written: {error.strerror or error}") from None
    return out
