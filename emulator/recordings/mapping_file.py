"""A user's own names of joints: lines ``file_name: joint`` or ``file_name,joint``; ``-`` leaves a joint out."""

from __future__ import annotations

import re
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from emulator.recordings import RecordingError
from emulator.recordings.text import quoted, text_lines
from emulator.skeleton import CANONICAL, EXTRA

LEFT_OUT = "-"
_HEADER = re.compile(
    r"^(name|file_name|marker|joint|from)\s*[,:]\s*(joint|canonical|canonical_name|to)$", re.IGNORECASE
)


def read_mapping(path: Path, names: Sequence[str]) -> dict[str, str]:
    """Of each joint of the file that the mapping names, its canonical name, or ``-`` where it is left out.

    names : the joints there are
    Raises RecordingError with every wrong line: its number, what was found, the nearest right word.
    """
    mapping: dict[str, str] = {}
    first: dict[tuple[str, str], int] = {}
    wrong = []
    for number, line in text_lines(path):
        text = line.split("#", 1)[0].strip()
        if not text or _HEADER.match(text):
            continue
        name, joint = _parts(text)
        problems = _problems(name, joint, names)
        said = [("name", name)] + ([] if joint == LEFT_OUT else [("joint", joint)])
        for word in said:
            if not problems and word in first:
                problems = [f"found the {word[0]} {quoted(word[1])} a second time, first in line {first[word]}"]
        wrong += [f"{path}:{number}: {problem}" for problem in problems]
        mapping[name] = joint
        for word in said:
            first.setdefault(word, number)
    if not first and not wrong:
        wrong.append(f"{path}: found no line, expected lines such as 'Bip01 L Thigh: left_hip'")
    if wrong:
        raise RecordingError("\n".join(wrong))
    return mapping


def _parts(text: str) -> tuple[str, str]:
    """Cut at the last colon or comma: names can hold colons themselves."""
    found = re.match(r"^(.*)[:,\t]\s*([^:,\t]*)$", text)
    return (found.group(1).strip().strip('"'), found.group(2).strip().strip('"')) if found else (text, "")


def _problems(name: str, joint: str, names: Sequence[str]) -> list[str]:
    if not joint:
        return [f"found {quoted(name)}, expected 'name in the file: joint'"]
    problems = []
    if name not in names:
        problems.append(f"no joint {quoted(name)} in the recording{_near(name, names)}")
    if joint not in (*CANONICAL, *EXTRA, LEFT_OUT):
        problems.append(f"no joint is called {quoted(joint)}{_near(joint, (*CANONICAL, *EXTRA))}")
    return problems


def _near(word: str, known: Sequence[str]) -> str:
    near = get_close_matches(word, known, n=1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else f"; known: {', '.join(list(known)[:12])}"
