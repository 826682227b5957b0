"""Arrays out of an .npz file that may be hostile: declared sizes are compared before anything is allocated.

The file of a library: arrays and a JSON header in one .npz, no pickles; the same content gives the same bytes.
"""

from __future__ import annotations

import io
import json
import math
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import numpy as np

_HEADS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


class MemberError(ValueError):
    """An .npz file, or an array in it, that cannot be read; the message does not name the file."""


def open_members(path: Path, most_bytes: int, most_arrays: int) -> zipfile.ZipFile:
    """The file, opened; its arrays unpack to at most ``most_bytes`` bytes.

    Raises FileNotFoundError, and MemberError for what is no .npz file or declares more than is allowed.
    """
    try:
        file = zipfile.ZipFile(path)
    except FileNotFoundError:
        raise
    except (OSError, zipfile.BadZipFile, ValueError) as why:
        raise MemberError(str(why)) from None
    entries = file.infolist()
    declared = sum(entry.file_size for entry in entries)
    if declared > most_bytes or len(entries) > most_arrays:
        file.close()
        raise MemberError(
            f"larger than it may be: {len(entries)} arrays that unpack to {declared / 2**20:,.0f} MB, "
            f"expected at most {most_arrays} and {most_bytes // 2**20:,} MB"
        )
    return file


def read_member(file: zipfile.ZipFile, name: str) -> np.ndarray:
    """The array of the member ``name``, never a pickle. Raises KeyError where there is none, MemberError if damaged."""
    entry = file.getinfo(name)
    try:
        with file.open(entry) as stream:
            return _array(stream, entry.file_size, name)
    except MemberError:
        raise
    except Exception as why:  # zlib, zipfile, numpy and tokenizer errors of a damaged file are of many kinds
        raise MemberError(f"{name} is damaged ({why})") from None


def _array(stream: IO[bytes], size: int, name: str) -> np.ndarray:
    version = np.lib.format.read_magic(stream)
    if version not in _HEADS:
        raise MemberError(f"{name} is written in version {version} of the .npy form, expected 1.0 or 2.0")
    shape, by_columns, dtype = _HEADS[version](stream)
    if dtype.hasobject:
        raise MemberError(f"{name} holds Python objects, expected numbers or text")
    declared, there = math.prod(shape) * max(dtype.itemsize, 1), size - stream.tell()
    if declared != there or min(shape, default=0) < 0:
        raise MemberError(f"{name} is damaged: it declares {shape} of {dtype}, {declared} bytes, and holds {there}")
    content = bytearray(stream.read(there))  # never more than `there`, and checked against its CRC
    if len(content) != there:
        raise MemberError(f"{name} is damaged: it ends after {len(content)} of {there} bytes")
    return np.ndarray(shape, dtype, buffer=content, order="F" if by_columns else "C")


FORMAT = "opsim motion library"
VERSION = 1
MAX_BYTES = 512 * 2**20
MAX_HEADER_BYTES = 4 * 2**20
MAX_ARRAYS = 20_000


class LibraryError(ValueError):
    """A motion library that cannot be read or used; the message names the file and what is wrong with it."""


def write_archive(path: Path, header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    """Write header and arrays, under a temporary name first, so that no half file is ever left.

    Raises OSError that names ``path``, and leaves nothing behind, where it cannot be written.
    """
    text = json.dumps({"format": FORMAT, "version": VERSION} | header, indent=1, ensure_ascii=False, allow_nan=False)
    members = {"header": np.frombuffer(text.encode(), dtype=np.uint8)} | arrays
    part = path.with_name(path.name + ".part")
    try:
        _write(part, members)
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise OSError(error.errno, error.strerror, str(path)) from None


def _write(part: Path, members: dict[str, np.ndarray]) -> None:
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as file:
        for name, array in members.items():
            stream = io.BytesIO()
            np.lib.format.write_array(stream, np.ascontiguousarray(array), allow_pickle=False)
            # a fixed date: the time of writing would change the hash of an unchanged library
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            file.writestr(entry, stream.getvalue())


def read_header(path: str | Path) -> dict[str, Any]:
    """The JSON header of a library, without reading any array. Raises LibraryError."""
    with _opened(Path(path)) as file:
        return _header(Path(path), file)


def read_archive(path: Path) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Header and all arrays. Raises LibraryError for what is no library, too new, broken, too large or not finite."""
    with _opened(path) as file:
        header = _header(path, file)
        names = [entry.filename for entry in file.infolist() if entry.filename != "header.npy"]
        arrays = {name.removesuffix(".npy"): _array_from_file(path, file, name) for name in names}
    return header, arrays


def _opened(path: Path) -> zipfile.ZipFile:
    try:
        return open_members(path, MAX_BYTES, MAX_ARRAYS)
    except FileNotFoundError:
        raise LibraryError(f"{path}: no such file") from None
    except MemberError as why:
        raise LibraryError(f"{path}: not a motion library ({why})") from None


def _header(path: Path, file: zipfile.ZipFile) -> dict[str, Any]:
    try:
        if file.getinfo("header.npy").file_size > MAX_HEADER_BYTES:
            raise LibraryError(f"{path}: its header is too large")
        header = json.loads(_array_from_file(path, file, "header.npy").tobytes().decode())
    except KeyError:
        raise LibraryError(f"{path}: not a motion library (no header; recordings need `opsim motion fit`)") from None
    except (ValueError, RecursionError) as why:
        raise why if isinstance(why, LibraryError) else LibraryError(f"{path}: its header cannot be read") from None
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        raise LibraryError(f"{path}: not a motion library (its header says something else)")
    if header.get("version") != VERSION:
        raise LibraryError(f"{path}: library version {header.get('version')!r}; this opsim reads version {VERSION}")
    return header


def _array_from_file(path: Path, file: zipfile.ZipFile, name: str) -> np.ndarray:
    try:
        array = read_member(file, name)
    except MemberError as why:
        raise LibraryError(f"{path}: {why}") from None
    if array.dtype.kind not in "fiu" or (array.dtype.kind == "f" and not np.all(np.isfinite(array))):
        raise LibraryError(f"{path}: {name} holds something other than finite numbers")
    return array
