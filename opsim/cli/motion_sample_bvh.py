"""Drawn performances as BVH, a file each, for programs of animation and motion capture."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any


def bvh_files(out: Path, n: int) -> list[Path]:
    """``out`` itself for one performance; else ``out`` with _k0, _k1, ... before its ending, as wide as the last."""
    if n == 1:
        return [out]
    digits = len(str(n - 1))
    return [out.with_stem(f"{out.stem}_k{k:0{digits}d}") for k in range(n)]


def write_bvh_files(out: Path, drawn: Any, fps: float, frame_times_s: Callable[[float, float], Any]) -> list[Path]:
    """Write each performance, and return the files.

    y points up, and our x stays X: what we import again is where it was and faces as it did. Who begins facing x faces
    X in the program of animation, not Z.
    """
    from emulator.recordings.bvh_write import write_bvh
    from emulator.recordings.take import Take

    files = bvh_files(out, len(drawn.duration_s))
    for k, file in enumerate(files):
        places = drawn[k].positions_m(times_s=frame_times_s(drawn.duration_s[k], fps))[0]
        write_bvh(Take(drawn.skeleton.names, drawn.skeleton.parents, places, fps, trial=f"k{k}"), file)
    return files


def of_another_draw(out: Path, n: int) -> tuple[list[Path], list[Path]]:
    """Files beside those of this draw that an earlier one to the same name left: (ours, those of other joints)."""
    new = {file.name for file in bvh_files(out, n)}
    name = re.compile(re.escape(out.stem) + r"(_k[0-9]+)?" + re.escape(out.suffix))
    there = [file for file in sorted(out.parent.iterdir()) if name.fullmatch(file.name) and file.name not in new]
    there = [file for file in there if file.is_file() and not file.is_symlink()]
    ours = [file for file in there if _is_ours(file)]
    return ours, [file for file in there if file not in ours]


def _is_ours(file: Path) -> bool:
    """Whether its joints are called as those that we write."""
    from emulator.skeleton import CANONICAL, EXTRA

    with file.open("rb") as stream:
        head = stream.read(1 << 16)
    names = re.findall(rb"^\s*(?:ROOT|JOINT) (\S+)\s*$", head, re.MULTILINE)
    return bool(names) and {name.decode("latin-1") for name in names} <= {*CANONICAL, *EXTRA}
