"""Take: joints (or markers) through time as a capture system gave them, with gaps. Recording: takes of one skeleton.

This is what readers give and what cleaning and segmenting pass on; a ``MotionSet`` is made of it at the end.

Who and which take, by the name of the file: parts such as s01 and e02, or a pattern of the user's.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from emulator.recordings.text import RecordingError


@dataclass(frozen=True, eq=False)
class Take:
    """One recording in a row, in metres, right-handed, z up.

    names       : (J,) of joints or markers, as the file or, once mapped, as ``emulator.skeleton`` calls them
    parents     : (J,) joint number of each joint's parent, -1 for the root; None where the points are markers
    positions_m : (T, J, 3), nan where a point was not seen
    rate_hz     : frames a second
    mark_frame  : frames (from 0, also between frames) at which something happened, by name
    contact     : (T, 2) whether the left and the right foot bear, or None where nobody said
    notes       : what was assumed or changed on the way here, in words
    Raises ValueError that names the take where shapes disagree or the rate is no positive number.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...] | None
    positions_m: np.ndarray
    rate_hz: float
    worker: str = "unknown"
    trial: str = "1"
    mark_frame: Mapping[str, float] = field(default_factory=dict)
    covariates: Mapping[str, Any] = field(default_factory=dict)
    contact: np.ndarray | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        n_frames = len(self.positions_m)
        if np.shape(self.positions_m) != (n_frames, len(self.names), 3):
            found = np.shape(self.positions_m)
            raise ValueError(f"take {self.name}: positions must be (T, {len(self.names)}, 3), found {found}")
        if self.parents is not None and len(self.parents) != len(self.names):
            raise ValueError(f"take {self.name}: {len(self.names)} names and {len(self.parents)} parents (one each)")
        if self.contact is not None and np.shape(self.contact) != (n_frames, 2):
            raise ValueError(f"take {self.name}: contact must be ({n_frames}, 2), found {np.shape(self.contact)}")
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0):
            raise ValueError(f"take {self.name}: found {self.rate_hz} frames a second, expected a positive number")

    @property
    def name(self) -> str:
        return f"{self.worker}/{self.trial}"

    @property
    def n_frames(self) -> int:
        return len(self.positions_m)

    @property
    def duration_s(self) -> float:
        """From the first frame to the last."""
        return (self.n_frames - 1) / self.rate_hz


@dataclass(frozen=True, eq=False)
class Recording:
    """Takes with the same joints and rate, and where they come from. Raises ValueError where they disagree."""

    takes: tuple[Take, ...]
    source: str = "not stated"
    licence: str = "not stated"
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "takes", tuple(self.takes))
        if not self.takes:
            raise ValueError("a recording needs a take; found none")
        first = self.takes[0]
        for take in self.takes[1:]:
            if (take.names, take.parents) != (first.names, first.parents):
                raise ValueError(f"take {take.name} has other joints than {first.name}")
            if take.rate_hz != first.rate_hz:
                raise ValueError(
                    f"take {take.name} has {take.rate_hz:g} frames a second, {first.name} {first.rate_hz:g}"
                )
            if set(take.mark_frame) != set(first.mark_frame):
                raise ValueError(f"take {take.name} has other marks than {first.name}")

    @property
    def names(self) -> tuple[str, ...]:
        return self.takes[0].names

    @property
    def parents(self) -> tuple[int, ...] | None:
        return self.takes[0].parents

    @property
    def rate_hz(self) -> float:
        return self.takes[0].rate_hz


_WORKER = re.compile(
    r"(?:^|[_\-. ])((?:s|sub|subj|subject|p|participant|person|w|worker|actor)[_-]?\d+)(?=[_\-. ]|$)", re.IGNORECASE
)
_PARTS = r"(\{worker\}|\{trial\}|\*)"
_TRIAL = re.compile(r"(?:^|[_\-. ])((?:e|r|rep|repetition|trial|take|t)[_-]?\d+)(?=[_\-. ]|$)", re.IGNORECASE)


def named(take: Take, path: Path, worker: str | None, trial: str | None, names_as: str | None, n: int) -> Take:
    """Worker and trial as given; else by parts of the file's name such as s01 and e02, else the whole name as trial."""
    said = {} if names_as is None else parts_of_name(path, names_as)
    who, which = _WORKER.search(path.stem), _TRIAL.search(path.stem)
    told = worker or said.get("worker") or (who.group(1) if who else "unknown")
    run = trial or said.get("trial") or (which.group(1) if which and who else path.stem)
    return replace(take, worker=told, trial=run if n == 1 else f"{take.worker} {take.trial}")


def wrong_pattern(names_as: str) -> str:
    """What is wrong with a pattern for any file; empty if nothing."""
    parts = re.split(_PARTS, names_as)
    named = parts[1::2]
    named = [part for part in named if part != "*"]
    odd = [found for part in parts[::2] for found in re.findall(r"\{[^{}]*\}?|\}", part)]
    if odd:
        return f"--names: found {', '.join(map(repr, odd[:3]))} in {names_as!r}, expected {{worker}}, {{trial}} or *"
    if not named or len(set(named)) != len(named):
        return f"--names: found {names_as!r}, expected {{worker}} or {{trial}} in it, each once at most"
    return ""


def parts_of_name(path: Path, names_as: str) -> dict[str, str]:
    """``worker`` and ``trial`` out of a file's name by a pattern; ``*`` is anything. Raises RecordingError."""
    if wrong := wrong_pattern(names_as):
        raise RecordingError(wrong)
    parts = re.split(_PARTS, names_as.removesuffix(path.suffix))
    for one in (r"[^_\-. ]+", r".+?"):  # a part between two signs where that fits, else any
        words = {"{worker}": f"(?P<worker>{one})", "{trial}": f"(?P<trial>{one})", "*": r".*?"}
        found = re.fullmatch("".join(words.get(part) or re.escape(part) for part in parts), path.stem)
        if found is not None:
            return found.groupdict()
    raise RecordingError(f"{path}: the name does not fit --names {names_as!r}")
