"""When the load of ``opsim motion score`` is in the hands: between marks of the movement, or shares of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

EXAMPLE = "such as 'grasp..1.0', from a mark or a share of the movement to a later one"
Said = str | float


@dataclass(frozen=True)
class LoadedTime:
    """From one moment of each movement to another, each the name of a mark or a share from 0 to 1."""

    start: Said
    end: Said

    def unknown(self, mark_names: Sequence[str]) -> list[str]:
        """What speaks against it where movements have marks of these names."""
        from opsim.problems import nearest, shown

        named = [said for said in (self.start, self.end) if isinstance(said, str) and said not in mark_names]
        has = f"the movement has {', '.join(mark_names) or 'no marks, only shares such as 0.2..1.0'}"
        near = {said: nearest(said, mark_names) for said in named}
        return [
            f"--loaded: no mark {shown(said)}; {f'did you mean {shown(near[said])}?' if near[said] else has}"
            for said in named
        ]

    def moments(self, mark_names: Sequence[str]) -> tuple[Any, Any]:
        """Both as ``plan.tools.Moment``. Raises ValueError for another name."""
        from opsim.plan.tools import moment_of

        names = tuple(mark_names)
        return moment_of(self.start, names), moment_of(self.end, names)

    def in_take(self, mark_frame: Mapping[str, float], n_frames: int) -> tuple[float, float]:
        """From and to which share of a take of ``n_frames``; nan where the mark is not known in it."""
        start, end = (_share(said, mark_frame, n_frames) for said in (self.start, self.end))
        return start, end

    @property
    def words(self) -> str:
        return f"from {_in_words(self.start)} to {_in_words(self.end)}"


def loaded_of(text: str | None, wrong: list[str]) -> LoadedTime | None:
    """From ``FROM..TO``; an empty side is the beginning, or the end."""
    from opsim.problems import shown

    if text is None:
        return None
    start_text, dots, end_text = text.partition("..")
    start, end = _said(start_text, 0.0), _said(end_text, 1.0)
    numbers = [said for said in (start, end) if isinstance(said, float)]
    inside = all(0 <= said <= 1 for said in numbers)
    if not dots or not inside or start == end or (len(numbers) == 2 and numbers[0] > numbers[1]):
        wrong.append(f"--loaded: found {shown(text)}, expected FROM..TO, {EXAMPLE}")
        return None
    return LoadedTime(start, end)


def _said(text: str, otherwise: float) -> Said:
    if not text.strip():
        return otherwise
    try:
        return float(text)
    except ValueError:
        return text.strip()


def _share(said: Said, mark_frame: Mapping[str, float], n_frames: int) -> float:
    """A mark lies in the middle of its frame, as every frame is a while."""
    return said if isinstance(said, float) else (float(mark_frame[said]) + 0.5) / n_frames


def _in_words(said: Said) -> str:
    return f"{100 * said:g} %" if isinstance(said, float) else said
