"""Which files hold recordings: by their endings, who reads them, and what may be said of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Format:
    """A format's name, the module and function that read it, and the options of ``read_take`` that it takes."""

    name: str
    module: str
    reader: str
    options: tuple[str, ...] = ("unit_m", "up")


FORMATS = {
    ".bvh": Format("BVH", "bvh", "read_bvh"),
    ".amc": Format("ASF/AMC", "amc", "read_amc", ("unit_m", "up", "rate_hz", "asf")),
    ".c3d": Format("C3D", "c3d", "read_c3d"),
    ".trc": Format("TRC", "c3d", "read_trc"),
    ".csv": Format("CSV", "marker_csv", "read_csv", ("unit_m", "up", "rate_hz", "columns", "min_score")),
    ".tsv": Format("TSV", "marker_csv", "read_csv", ("unit_m", "up", "rate_hz", "columns", "min_score")),
    ".json": Format("keypoint JSON", "keypoints", "read_json", ("unit_m", "up", "rate_hz", "columns", "min_score")),
}
"""Formats by the ending of their files; ``.npz`` besides, which can hold many takes."""
OPTIONS = {
    "unit_m": "the unit",
    "up": "the axis that points up",
    "rate_hz": "the frame rate",
    "columns": "names of the columns",
    "asf": "a skeleton file",
    "min_score": "a least confidence",
    "mapping_file": "a mapping file",
}


def way_to_npz(path: Path) -> str:
    """How a file of another form becomes a recording; empty where no reader knows its ending."""
    known = path.suffix.lower() in FORMATS
    return f"; 'opsim motion import {path.name} -o {path.stem}.npz' makes one of it" if known else ""
