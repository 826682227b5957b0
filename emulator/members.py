"""Arrays out of an .npz file that may be hostile: declared sizes are compared before anything is allocated."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import IO

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
