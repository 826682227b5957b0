"""Who and which take, by the name of the file: parts such as s01 and e02, or a pattern of the user's."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

from emulator.recordings import RecordingError
from emulator.recordings.take import Take

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
