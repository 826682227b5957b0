"""Header and parameters of a C3D file by its specification (c3d.org, 2008), for Intel, DEC and MIPS processors.

NOTE: read by hand and not with ezc3d, which died (segmentation fault) on 9 of 400 files with 1 to 16 changed bytes; it
is the oracle of the tests. Nothing here is allocated by what a file declares before that is held against its size.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86


class C3dError(ValueError):
    """Bytes that are no C3D file; the message does not name the file."""


@dataclass(frozen=True)
class Parameter:
    """``values`` flat, the first dimension fastest; text as a list of strings in ``text``."""

    values: np.ndarray
    text: tuple[str, ...] = ()


@dataclass(frozen=True)
class Header:
    """The numbers of the first block; ``data_start`` is a block number from 1."""

    processor: int
    n_points: int
    analog_per_frame: int
    first_frame: int
    last_frame: int
    scale: float
    data_start: int
    rate_hz: float
    parameters: dict[str, Parameter] = field(default_factory=dict)


def read_header(content: bytes) -> Header:
    """The header with its parameters, by ``GROUP:NAME`` in capitals. Raises C3dError."""
    if len(content) < 2 * BLOCK:
        raise C3dError(f"found {len(content)} bytes, expected {2 * BLOCK} at least")
    if content[1] != 0x50:
        raise C3dError(f"found {content[1]:#04x} as second byte, expected 0x50, by which a C3D file is known")
    start = (content[0] - 1) * BLOCK
    if start < BLOCK or start + 4 > len(content):
        raise C3dError(f"found the parameters in block {content[0]}, expected 2 to {len(content) // BLOCK}")
    processor = content[start + 3]
    if processor not in (INTEL, DEC, MIPS):
        raise C3dError(f"found processor type {processor}, expected 84 (Intel), 85 (DEC) or 86 (MIPS)")
    words = np.frombuffer(content, ">u2" if processor == MIPS else "<u2", 12)
    floats = floats_of(content[:48], processor)
    return Header(
        processor,
        n_points=int(words[1]),
        analog_per_frame=int(words[2]),
        first_frame=int(words[3]),
        last_frame=int(words[4]),
        scale=float(floats[3]),
        data_start=int(words[8]),
        rate_hz=float(floats[5]),
        parameters=_parameters(content[start:], processor),
    )


def floats_of(content: bytes | np.ndarray, processor: int) -> np.ndarray:
    """Numbers of four bytes each in the way of a processor, as double precision."""
    if processor == DEC:  # VAX F-floating: words exchanged, and four times as large
        words = np.frombuffer(content, "<u2").reshape(-1, 2)[:, ::-1]
        with np.errstate(invalid="ignore", over="ignore"):
            return np.ascontiguousarray(words).view("<f4").reshape(-1).astype(float) / 4
    with np.errstate(invalid="ignore"):
        return np.frombuffer(content, ">f4" if processor == MIPS else "<f4").astype(float)


def _parameters(section: bytes, processor: int) -> dict[str, Parameter]:
    """Of the parameter section all that can be read; what points outside of it ends the reading."""
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Parameter]] = []
    end = min(len(section), max(section[2], 1) * BLOCK)
    at = 4
    while at + 4 <= end:
        length, number = abs(_signed(section[at])), _signed(section[at + 1])
        name = section[at + 2 : at + 2 + length].decode("latin-1").strip().upper()
        link = at + 2 + length
        if not length or not number or link + 2 > end:
            break
        if number < 0:
            groups[-number] = name
        else:
            parameter = _parameter(section[link + 2 : end], processor)
            if parameter is not None:
                found.append((number, name, parameter))
        step = int.from_bytes(section[link : link + 2], "big" if processor == MIPS else "little")
        if step < 2:
            break
        at = link + step
    return {f"{groups.get(number, '')}:{name}": parameter for number, name, parameter in found}


def _parameter(content: bytes, processor: int) -> Parameter | None:
    """A parameter from its type on; None where it does not fit into the rest of the section."""
    if len(content) < 2 or len(content) < 2 + content[1]:
        return None
    kind, dimensions = _signed(content[0]), list(content[2 : 2 + content[1]])
    count = int(np.prod(dimensions, dtype=np.int64)) if len(dimensions) < 8 else -1
    size = {-1: 1, 1: 1, 2: 2, 4: 4}.get(kind, 0) * count
    data = content[2 + len(dimensions) : 2 + len(dimensions) + size]
    if size <= 0 or len(data) < size:
        return None
    if kind == -1:
        width = dimensions[0] if dimensions else 1
        words = [data[i : i + width] for i in range(0, len(data), width)]
        return Parameter(np.empty(0), tuple(word.decode("utf-8", "replace").strip(" \0") for word in words))
    if kind == 4:
        return Parameter(floats_of(data, processor))
    return Parameter(np.frombuffer(data, "u1" if kind == 1 else ">u2" if processor == MIPS else "<u2").astype(float))


def _signed(byte: int) -> int:
    return byte - 256 if byte > 127 else byte
