"""Files that ``opsim motion`` reads and writes: libraries found by path or shipped name, outputs tried beforehand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

FILES = (".csv", ".npz", ".html", ".svg", ".png", ".json", ".txt", ".parquet", ".gif", ".mp4")
"""Endings that a folder is not given on purpose."""


def chosen(library: str, task: str | None) -> Any:
    """The emulator of a task of a library file, or of a shipped library by its name. Raises ValueError."""
    from opsim.libraries import load_library

    loaded = load_library(found(library))
    return loaded.only() if task is None else loaded[task]


def library_and_task(library: str, task: str | None) -> tuple[str, str | None]:
    """Both of ``library/task``, as a scenario names an emulator, where no file is called so and no task is named."""
    if task is None and "/" in library and not library.endswith(".npz") and not _is_file(Path(library)):
        name, _, inside = library.rpartition("/")
        return name, inside
    return library, task


def found(library: str) -> Path:
    """The file of a library: at this path, or the shipped one of this name. Raises ValueError."""
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
    hint = did_you_mean(library, [*beside, *shipped], otherwise="libraries here and shipped ones", files=True)
    raise ValueError(f"no library {shown(library)}; {hint}")


def overwritten(out: Path | None, **reads: Sequence[str | Path]) -> list[str]:
    """What speaks against writing ``out``: that it is one of the files that are read, by whatever path.

    reads : files by what they are, such as ``recording=files``; those that are not there are passed over
    """
    if out is None or not _is_file(out):
        return []
    return [
        f"{out}: found the {what.replace('_', ' ')} that is read, expected another file to write"
        for what, files in reads.items()
        if any(_is_file(Path(file)) and out.samefile(file) for file in files)
    ]


def of_another_kind(out: Path, kind: str) -> list[str]:
    """What speaks against writing an .npz ``out`` of this kind: a recording or a library there that is of the other."""
    there = _kind(out)
    if there in (None, kind):
        return []
    return [f"{out}: found a {there}, expected a new file or a {kind} to replace"]


def _kind(file: Path) -> str | None:
    """Recording or library, by the names of its arrays; None for what is neither."""
    import zipfile

    if not _is_file(file):
        return None
    try:
        with zipfile.ZipFile(file) as members:
            names = set(members.namelist())
    except (OSError, ValueError, zipfile.BadZipFile):
        return None
    return "library" if "header.npy" in names else "recording" if "positions.npy" in names else None


def _is_file(path: Path) -> bool:
    return "\0" not in str(path) and path.is_file()


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


def wrong_folder(out: Path) -> list[str]:
    """What speaks against writing into a folder of this name: a file there, or the ending of one."""
    if _is_file(out):
        return [f"{out}: found a file, expected a folder to write into"]
    if out.suffix.lower() in FILES and not out.is_dir():
        return [f"{out}: found the ending {out.suffix!r} of a file, expected a folder to write into"]
    return []


@contextmanager
def no_empty_folders(folder: Path) -> Iterator[None]:
    """Of ``folder`` and those above it, what this block makes and leaves empty is gone at its end."""
    new = [each for each in (folder, *folder.parents) if not each.exists()]
    try:
        yield
    finally:
        for each in new:
            with suppress(OSError):
                each.rmdir()
