"""What ``opsim view`` is asked for, checked before anything is drawn: every mistake is said at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

MOST = 2
"""Variants side by side."""


@dataclass(frozen=True)
class Asked:
    """The options as they were given; low, high : texts of --from and --to."""

    names: tuple[str, ...] = ()
    replication: int = 0
    low: str | None = None
    high: str | None = None
    out: Path | None = None

    def checked(self, folder: Path, results: Mapping[str, Any]) -> Wanted:
        """What to show of the variants in ``folder``. Raises ValueError with every mistake, a line each."""
        from opsim.study.reopened import reopened

        wrong = [*wrong_names(self.names, results, str(folder)), *wrong_file(self.out, results)]
        names = [name for name in dict.fromkeys(self.names) if name in results] or [usual(results)]
        runs, window = {}, None
        for name in names:
            wrong += _rows(results[name], self.replication)
            try:
                runs[name] = reopened(results[name].folder)
            except (ValueError, OSError) as error:
                wrong.append(_said(error))
        try:
            window = stretch(self, [run.loaded.scenario.run for run in runs.values()])
        except ValueError as error:
            wrong.append(str(error))
        if wrong:
            raise ValueError("\n".join(dict.fromkeys(wrong)))
        beside = folder if len(runs) > 1 else next(iter(runs.values())).result.folder
        return Wanted(runs, self.replication, window, self.out or beside / "replay.html")


@dataclass(frozen=True)
class Wanted:
    """runs : Reopened by variant, in the order to show; window_s : on the run's clock, None for all of it."""

    runs: dict[str, Any]
    replication: int
    window_s: tuple[float, float] | None
    out: Path


def usual(variants: Mapping[str, Any]) -> str:
    """The variant that is shown where nobody says which."""
    return "base" if "base" in variants else str(next(iter(variants)))


def wrong_names(names: Sequence[str], variants: Mapping[str, Any], where: str) -> list[str]:
    """What is wrong with the variants asked for."""
    from opsim.problems import did_you_mean, shown

    wrong = [
        f"{where}: no variant {shown(name)}; {did_you_mean(name, variants, otherwise='there are')}"
        for name in dict.fromkeys(names)
        if name not in variants
    ]
    if len(names) > MOST:
        wrong.append(f"--scenario: found {len(names)}, expected one, or two to see side by side")
    if len(set(names)) < len(names):
        wrong.append("--scenario: found the same variant twice, expected two different ones")
    return wrong


def wrong_file(out: Path | None, held: Mapping[str, Any]) -> list[str]:
    """What keeps the page from being written; held : results that it is not to lie over."""
    from opsim.cli.results_files import wrong_page

    return [] if out is None else wrong_page(out, held)


def _rows(result: Any, replication: int) -> list[str]:
    from opsim.results import lacking_rows

    if gone := lacking_rows(result):
        return [gone]
    n = len(result.events_files)
    if replication < n:
        return []
    return [f"--replication: found {replication}, {result.folder} holds {f'0 to {n - 1}' if n > 1 else 'only 0'}"]


def stretch(asked: Asked, runs: Sequence[Any]) -> tuple[float, float] | None:
    """The stretch that is shown of runs, which must lie in each; None for all of it. Raises ValueError."""
    from opsim.cli.view_window import window_s

    if not runs:
        return None
    starts = {run.start_s for run in runs}
    if len(starts) > 1:
        raise ValueError("--scenario: the two variants begin at different times: they have no common clock")
    return window_s(asked.low, asked.high, starts.pop(), min(run.horizon_s for run in runs))


def _said(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}"
    return str(error)
