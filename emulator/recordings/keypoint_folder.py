"""A folder of keypoints with a file a frame, as OpenPose writes them: ``take_000000000012_keypoints.json``."""

from __future__ import annotations

import re
from pathlib import Path

KEYPOINT_FILES = "*_keypoints.json"


def is_keypoint_folder(path: Path) -> bool:
    """Whether this is a folder with at least one such file."""
    return "\0" not in str(path) and path.is_dir() and next(path.glob(KEYPOINT_FILES), None) is not None


def keypoint_files(folder: Path) -> list[Path]:
    """The files by the numbers in their names: frame 2 before frame 10."""
    return sorted(folder.glob(KEYPOINT_FILES), key=lambda file: (_in_order(file.name), file.name))


def _in_order(name: str) -> list[tuple[int, str]]:
    parts = re.split(r"([0-9]+)", name)
    return [(int(part), "") if i % 2 else (0, part) for i, part in enumerate(parts)]
