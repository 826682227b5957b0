"""Drawn performances as BVH, a file each, for programs of animation and motion capture."""

from __future__ import annotations

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
    """Write each performance, starting at the origin and facing Z, and return the files."""
    import numpy as np

    from emulator.recordings.bvh_write import write_bvh
    from emulator.recordings.take import Take

    files = bvh_files(out, len(drawn.duration_s))
    for k, file in enumerate(files):
        places = drawn[k].positions_m(times_s=frame_times_s(drawn.duration_s[k], fps))[0]
        facing = np.stack([places[..., 1], -places[..., 0], places[..., 2]], axis=-1)
        write_bvh(Take(drawn.skeleton.names, drawn.skeleton.parents, facing, fps, trial=f"k{k}"), file)
    return files
