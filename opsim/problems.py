"""Natural order of names: w2 before w10, so that the order of declaration decides nothing; and names in a sentence.

A user's mistakes: each with its place, what was found, what was expected and the nearest right word; and a plug-in's.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher, get_close_matches
from functools import lru_cache
from itertools import islice
from pathlib import PurePath

_DIGITS = re.compile(r"(\d+)")

Assumption = tuple[str, str]
"""A line of the assumption sheet: (topic, what is assumed)."""


@lru_cache(maxsize=8192)
def natural_key(name: str) -> tuple:
    """Sort key of a name with its numbers read as numbers; the name itself breaks ties such as ``w1`` and ``w01``."""
    parts = _DIGITS.split(name)
    return (*((int(part), "") if part.isdecimal() else (-1, part) for part in parts), (-2, name))


def listed(words: Iterable[str]) -> str:
    """Words with commas between them, the first seven of many."""
    words = list(words)
    return ", ".join(words) if len(words) <= 8 else ", ".join(words[:7]) + f" and {len(words) - 7} more"


def enumerated(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``; of more than six the first five."""
    if len(names) == 1:
        return names[0]
    shown = list(names) if len(names) <= 6 else [*names[:5], f"{len(names) - 5} more"]
    return f"{', '.join(shown[:-1])} and {shown[-1]}"


MOST_SHOWN = 50
WIDEST_LINE = 160
MOST_COMPARED = 2000
NEAR = 0.6
"""How like a word must be to be the one that was meant: twice the letters they share, in that of both."""
MOST_FOUND = 200
"""Problems that a reader looks for: more would be read by nobody, and a hostile file could hold a million."""


@dataclass(frozen=True, order=True)
class Problem:
    """One mistake. ``line`` and ``column`` count from 1; line 0 means the file as a whole."""

    file: str
    line: int
    column: int
    path: str
    message: str
    hint: str = ""
    source_line: str = ""

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}" if self.line else self.file
        head = ": ".join(part for part in (place, self.path, self.message) if part)
        if not self.line:
            return f"{head}\n  {self.hint}" if self.hint else head
        shown_line, caret = _window(self.source_line, self.column - 1)
        remark = f" {self.hint}" if self.hint else ""
        return f"{head}\n{self.line:6d} | {shown_line}\n       | {' ' * caret}^{remark}"


class ScenarioError(Exception):
    """A scenario that cannot be read; ``problems`` is a tuple of Problem, in the order of the file."""

    def __init__(self, problems: Iterable[Problem]):
        self.problems = tuple(problems)
        super().__init__(self.problems)

    def __str__(self) -> str:
        shown_problems = [str(problem) for problem in self.problems[:MOST_SHOWN]]
        return "\n".join([*shown_problems, self._total()])

    def _total(self) -> str:
        n = len(self.problems)
        files = sorted({problem.file for problem in self.problems})
        total = f"{n} problem{'' if n == 1 else 's'} in {', '.join(files)}"
        return total if n <= MOST_SHOWN else f"{total} (the first {MOST_SHOWN} are shown)"


class PluginError(ValueError):
    """A plug-in's own mistake; the text says which one, what it was doing, and where."""


class NoSuchPlugin(ValueError, KeyError):
    """A name that no installed plug-in has; the text holds the nearest that there is."""

    __str__ = Exception.__str__


def shown(value: object) -> str:
    """A value as a message names it: text in quotes, short and printable; nothing, a list, a block in words."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a block of keys"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}" if value else "an empty list"
    text = repr(value) if isinstance(value, str) else str(value)
    return text if len(text) <= 60 else text[:56] + "..." + (text[-1] if isinstance(value, str) else "")


def nearest(word: object, known: Iterable[str]) -> str | None:
    """The known word most like this one, of two that are as like the one that begins alike; None where none is near."""
    text = str(word)[:60].casefold()
    words = sorted(_comparable(str(word)[:60], known))
    by_folded = {known_word.casefold(): known_word for known_word in reversed(words)}
    matches = get_close_matches(text, by_folded, cutoff=NEAR)
    if not matches:
        return None
    return by_folded[max(matches, key=lambda one: (SequenceMatcher(None, one, text).ratio(), one[:1] == text[:1]))]


def nearest_file(name: object, files: Iterable[str]) -> str | None:
    """The file most like one of this name, compared without folder and ending, which alike files share anyway."""
    by_stem = {PurePath(file).stem: file for file in reversed(list(files))}
    near = nearest(PurePath(str(name)).stem, by_stem)
    return None if near is None else by_stem[near]


def _comparable(text: str, known: Iterable[str]) -> list[str]:
    """The known words; of thousands those that begin alike and are about as long, of more none: hints must be quick."""
    words = list(known)
    if len(words) <= MOST_COMPARED:
        return words
    if len(words) > 5 * MOST_COMPARED:
        return []
    alike = (one for one in words if one[:1] == text[:1] and abs(len(one) - len(text)) <= 1)
    return list(islice(alike, MOST_COMPARED))


def did_you_mean(
    word: object, known: Iterable[str], *, otherwise: str = "known", most: int = 12, files: bool = False
) -> str:
    """The hint for an unknown word: the nearest right one, or the words that are known, so many of them at most.

    files : whether the words are names of files
    """
    near = (nearest_file if files else nearest)(word, known := list(known))
    if near is not None:
        return f"did you mean {shown(near)}?"
    if not known or len(known) > MOST_COMPARED:
        return ""
    words = sorted(known)
    return f"{otherwise}: {', '.join(words[:most])}{', ...' if len(words) > most else ''}"


def _window(line: str, column: int) -> tuple[str, int]:
    """The part of a long line around a column, and the column in it; characters that do not print become '?'."""
    start = 0 if len(line) <= WIDEST_LINE else max(0, column - WIDEST_LINE // 2)
    seen = line[start : start + WIDEST_LINE]
    return "".join(c if c.isprintable() else (" " if c == "\t" else "?") for c in seen), column - start
