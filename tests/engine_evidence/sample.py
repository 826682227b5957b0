"""Floors that together show the whole vocabulary twice: ``make made-floors`` chooses them anew."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import partial
from pathlib import Path

FILE = Path(__file__).with_name("sample.txt")
SAMPLE: tuple[int, ...] = tuple(map(int, FILE.read_text().split()))
TIMES = 2
"""In so many floors of the sample each word is."""
ROWS_A_WORD = 4000
"""Rows of a log that are worth a word: short floors are taken rather."""


def chosen(words: Mapping[int, frozenset[str]], n_rows: Mapping[int, int]) -> tuple[int, ...]:
    """Numbers of floors: one after the other that with most words of which the ones before have not enough."""
    found: list[int] = []
    lacking = Counter({word: TIMES for of_one in words.values() for word in of_one})
    while lacking:
        left = {word for word, n in lacking.items() if n > 0}
        rest = (number for number in words if number not in found and left & words[number])
        best = max(rest, key=lambda number: (len(left & words[number]) - n_rows[number] / ROWS_A_WORD, -number))
        found.append(best)
        lacking = +(lacking - Counter(words[best]))
    return tuple(sorted(found))


def main() -> None:
    """Choose them, and write them down."""
    from engine_evidence.compared import floor_seen
    from engine_evidence.equality import compared
    from engine_evidence.floors import N_FLOORS

    found = compared(range(N_FLOORS), partial(floor_seen, simpy_only=True))
    words, n_rows = ({number: getattr(one, name) for number, one in enumerate(found)} for name in ("words", "n_rows"))
    FILE.write_text(" ".join(map(str, chosen(words, n_rows))) + "\n")


if __name__ == "__main__":
    main()
