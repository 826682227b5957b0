"""Performances that take another time than they were drawn with: the same movement, stretched as a whole."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np

    from opsim.task import Performances


@dataclass(frozen=True, eq=False)
class Retimed:
    """n performances that last ``duration_s`` (n,); marks and postures are those of ``body``, at the same shares of it.

    ``scores`` are the coefficients the body was drawn with: they tell its own duration, not this one.
    """

    body: Performances
    duration_s: np.ndarray

    def __getattr__(self, name: str) -> Any:
        """The lengths of the bones, beyond the seam, where the body has them: no time changes them."""
        if name != "bone_length_m":
            raise AttributeError(f"{type(self).__name__} has no {name}")
        return getattr(self.body, name)

    @property
    def scores(self) -> np.ndarray:
        return self.body.scores

    @property
    def skeleton(self) -> Any:
        return self.body.skeleton

    @cached_property
    def mark_s(self) -> np.ndarray:
        """(n, E) seconds from the start."""
        import numpy as np

        return np.asarray(self.body.mark_s) * self._stretch[:, None]

    def directions(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; ``times_s`` (T,) or (n, T) seconds of the new duration."""
        return self._decoded("directions", times_s, more)

    def positions_m(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; times as ``directions``."""
        return self._decoded("positions_m", times_s, more)

    def root_m(self, times_s: np.ndarray | None = None, **more: Any) -> np.ndarray:
        """As the body's; times as ``directions``."""
        return self._decoded("root_m", times_s, more)

    @cached_property
    def _stretch(self) -> np.ndarray:
        """(n,) the new duration over the body's own."""
        import numpy as np

        return self.duration_s / np.asarray(self.body.duration_s, dtype=float)

    def _decoded(self, what: str, times_s: np.ndarray | None, more: dict[str, Any]) -> np.ndarray:
        import numpy as np

        decode = getattr(self.body, what)
        if times_s is None:
            return np.asarray(decode(**more))
        own_s = np.asarray(times_s) / self._stretch[:, None]
        return np.asarray(decode(times_s=own_s[0] if len(own_s) == 1 else own_s, **more))


class RetimedRows(Retimed):
    """Performances of which some can be taken: ``performances[3]`` and slices are performances again."""

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, index: int | slice | np.ndarray) -> RetimedRows:
        import numpy as np

        body: Any = self.body
        rows = slice(index, index + 1 or None) if isinstance(index, (int, np.integer)) else index
        return RetimedRows(body[index], self.duration_s[rows])


def retimed(body: Performances, duration_s: np.ndarray) -> Retimed:
    """The performances of ``body`` in ``duration_s`` (n,) seconds; with rows to take where ``body`` has them."""
    kind = RetimedRows if hasattr(type(body), "__getitem__") else Retimed
    return kind(body, duration_s)
