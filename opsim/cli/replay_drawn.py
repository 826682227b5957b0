"""Making the page of a replay, with progress, and telling how large it became and what would make it smaller."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from opsim.cli.verbs import mistakes
from opsim.cli.view_asked import Wanted

QUICK_BYTES, MOST_BYTES = 25_000_000, 100_000_000
"""What a browser opens within seconds, and what it may not open at all."""


@dataclass(frozen=True)
class Drawn:
    """A page that was written: of what, in seconds of the run, and how large."""

    wanted: Wanted
    low_s: float
    high_s: float
    size: int

    def as_json(self) -> dict[str, Any]:
        """For machines."""
        runs = {name: str(run.result.folder) for name, run in self.wanted.runs.items()}
        return {
            "replay": str(self.wanted.out),
            "bytes": self.size,
            "variants": [{"variant": name, "folder": folder} for name, folder in runs.items()],
            "replication": self.wanted.replication,
            "window_s": [self.low_s, self.high_s],
        }

    def words(self, others: Sequence[str] = ()) -> list[str]:
        """For people; others : variants that are in the folder and not shown."""
        from opsim.report.words import listing

        said = [f"replay: {self.wanted.out} ({self.size / 1e6:.1f} MB)"]
        if self.size > QUICK_BYTES:
            said.insert(0, too_large(self.size, self.low_s, self.high_s, start_s(self.wanted)))
        if others:
            said.insert(0, f"also here: {listing(list(others))} (--scenario NAME; given twice, two side by side)")
        return said


def draw_replay(wanted: Wanted) -> Drawn:
    """Write the page of the runs that are wanted.

    A page that no browser would open is a mistake of the user's, said with what would make it smaller.
    """
    from opsim.cli.progress import progress
    from opsim.one_thread import lean
    from opsim.viewer.notes import notes_of
    from opsim.viewer.write import write_replay
    from opsim.whole import whole_file

    lean()
    parts: list[Any] = []
    first = next(iter(wanted.runs.values()))
    notes = notes_of({name: run.result.summary for name, run in wanted.runs.items()}, wanted.replication)
    for name, run in wanted.runs.items():
        with mistakes(), progress(f"draw {name}") as report:
            parts.append(_part(run, wanted, report, like=first))
    title = str(next(iter(wanted.runs.values())).result.summary["scenario"])
    low_s, high_s = parts[0][0]["low_s"], max(meta["high_s"] for meta, _ in parts)
    with mistakes(), whole_file(wanted.out) as unfinished:
        size = write_replay(parts, unfinished, title, notes)
        if size > MOST_BYTES:
            raise ValueError(f"{wanted.out}: not written; {too_large(size, low_s, high_s, start_s(wanted))}")
    return Drawn(wanted, low_s, high_s, size)


def _part(run: Any, wanted: Wanted, report: Callable[..., None], like: Any) -> tuple[dict[str, Any], bytes]:
    """One variant as the page reads it; benches face as in another one."""
    from opsim.one_thread import one_blas_thread
    from opsim.viewer.packed import packed
    from opsim.viewer.stage import scene_of

    with one_blas_thread():
        told = lambda done, total: report(done, total + 1)  # noqa: E731
        part = packed(scene_of(run, wanted.replication, wanted.window_s, told, like=like))
    report(1, 1)
    return part


def too_large(size: int, low_s: float, high_s: float, at_start_s: float) -> str:
    """What to say of a page of that many bytes: how many hours a page that opens quickly has room for."""
    from opsim.week_clock import clock_words

    room_s = (high_s - low_s) * QUICK_BYTES / size
    end_s = low_s + max(room_s // 900 * 900, min(room_s, 60.0))
    stretch = f"--from '{clock_words(low_s, at_start_s)}' --to '{clock_words(end_s, at_start_s)}'"
    return (
        f"{size / 1e6:.1f} MB are more than the {QUICK_BYTES / 1e6:.0f} MB that a browser opens quickly, "
        f"{size / 1e6 / ((high_s - low_s) / 3600):.1f} MB an hour; "
        f"{stretch} would make {size / 1e6 * (end_s - low_s) / (high_s - low_s):.0f} MB"
    )


def start_s(wanted: Wanted) -> float:
    """When the runs begin, in seconds after Monday 00:00."""
    return float(next(iter(wanted.runs.values())).loaded.scenario.run.start_s)
