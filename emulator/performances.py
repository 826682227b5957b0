"""Performances: what is drawn of a task, the same of all kinds: how long it takes, its marks, and bodies on demand."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Self

import numpy as np

from emulator.motion import frame
from emulator.skeleton import Skeleton

Floats = type[np.floating] | np.dtype


class Performances:
    """n performances of ``model``, each field but that one with n rows. A row or a slice are performances again.

    A kind of them says ``duration_s`` (n,), ``mark_s`` (n, E), and ``path`` besides its postures.
    """

    model: Any
    duration_s: np.ndarray

    def __len__(self) -> int:
        return len(self.duration_s)

    def __getitem__(self, index: int | slice | np.ndarray) -> Self:
        rows = slice(index, index + 1 or None) if isinstance(index, (int, np.integer)) else index
        own = {one.name: getattr(self, one.name) for one in fields(self)}  # type: ignore[arg-type]
        return type(self)(**{name: value if name == "model" else value[rows] for name, value in own.items()})

    @property
    def skeleton(self) -> Skeleton:
        skeleton: Skeleton = self.model.skeleton
        return skeleton

    def path(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 4) ``root_m`` and the heading in radians; times as ``directions``."""
        raise NotImplementedError

    def root_m(self, times_s: np.ndarray | None = None, n_times: int = 101) -> np.ndarray:
        """(n, T, 3) path of the root, metres, from x = y = 0, starting heading along x; times as ``directions``."""
        return self.path(times_s, n_times)[..., :3]

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row each: duration and marks. Raises ImportError where pandas is absent."""
        marks = np.asarray(self.mark_s)  # type: ignore[attr-defined]
        names = getattr(self.model, "mark_names", ())
        names = names if len(names) == marks.shape[1] else [f"mark{e}" for e in range(marks.shape[1])]
        return frame({"duration_s": self.duration_s, **{f"{name}_s": marks[:, e] for e, name in enumerate(names)}})

    def _repr_html_(self) -> str:
        from emulator.notebook import performances_html

        return performances_html(self)

    def _times(self, times_s: np.ndarray | None, n_times: int) -> np.ndarray:
        """(n, T) seconds that are asked for: ``n_times`` even points of own time, or ``times_s`` (T,) or (n, T)."""
        own = np.linspace(0, 1, n_times) * self.duration_s[:, None] if times_s is None else np.asarray(times_s, float)
        return np.broadcast_to(own, (len(self), np.shape(own)[-1]))
