"""``opsim view``: a run as a moving picture, one offline page.

What ``opsim view`` is asked for, checked before anything is drawn: every mistake is said at once.

The run that ``opsim view FILE`` makes first: only so many replications as are looked at, in a folder of its own.

A stretch of a run as people say it: '2 h' after its start, or 'Mon 07:30' on its clock.

Making the page of a replay, with progress, and telling how large it became and what would make it smaller.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import engine_option
from opsim.clock import clock_words, moment_s


@click.command("view")
@click.argument("of", metavar="RESULTS|FILE")
@click.option(
    "--scenario",
    "names",
    multiple=True,
    metavar="NAME",
    help="The variant to show; given twice, two side by side on one clock.  [default: base, or the first]",
)
@click.option("--replication", type=click.IntRange(min=0), default=0, show_default=True, help="Which one, from 0 on.")
@click.option("--from", "low", metavar="TIME", help="From here on: '2 h' of the run, or a clock, 'Mon 07:30'.")
@click.option("--to", "high", metavar="TIME", help="As far as here.  [default: all of the run]")
@engine_option(None)
@click.option("-o", "--out", type=click.Path(path_type=Path), help="An .html file.  [default: replay.html in RESULTS]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(of: str, engine: str | None, as_json: bool, **options: Any) -> None:
    """Write the replay of a run: layout, parts and people moving in step with the clock, in one offline page.

    RESULTS is the folder of a run or of one of its variants. A scenario FILE is run once first.
    Keys in the page: space plays and pauses, arrows step, 1 to 4 choose the speed, ? opens the notes with all of them.
    """
    from opsim.cli.app import print_json
    from opsim.results import variants_in

    asked = Asked(**options)
    with mistakes():
        if Path(of).is_dir():
            if engine is not None:
                raise ValueError(f"--engine: only where a scenario FILE is run; {of} is a folder of results")
            folder, results = Path(of), variants_in(Path(of))
            known = list(results)
        else:
            folder, asked, known = run_first(of, asked, engine)
            results = variants_in(folder)
        wanted = asked.checked(folder, results)
    drawn = draw_replay(wanted)
    if as_json:
        print_json(drawn.as_json())
        return
    for line in drawn.words(others=[name for name in known if name not in wanted.runs]):
        click.echo(line)


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
        from opsim.study.run import reopened

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
    from opsim.cli.report import wrong_page

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


def run_first(file: str, asked: Asked, engine: str | None = None) -> tuple[Path, Asked, list[str]]:
    """The results folder, what is asked for with the names of the variants that were run, and the names of all.

    The folder is ``results/<file's name>_view``; what it holds of another scenario is removed. Raises ScenarioError,
    ValueError with all that is wrong with what is asked for, before anything is run, OSError.
    """
    from opsim.cli.run_variants import run_variants
    from opsim.scenario import read_scenarios
    from opsim.study.results_folder import other_run

    known = read_scenarios(file)
    names = tuple(name for name in asked.names if name in known) or (usual(known),)
    wrong = [*wrong_names(asked.names, known, file), *wrong_file(asked.out, {})]
    try:
        stretch(asked, [known[name].scenario.run for name in names])
    except ValueError as error:
        wrong.append(str(error))
    if wrong:
        raise ValueError("\n".join(wrong))
    out = Path("results") / f"{known[names[0]].file.stem}_view"
    stale = any(other_run(out / name, known[name], known[name].scenario.run.seed) for name in names)
    if stale:
        click.echo(f"{out}: holds the run of a scenario that has changed since; run anew", err=True)
    run_variants(file, out, names=names, replications=asked.replication + 1, overwrite=stale, engine=engine)
    return out, replace(asked, names=names), list(known)


def window_s(low: str | None, high: str | None, start_s: float, horizon_s: float) -> tuple[float, float] | None:
    """(low, high) in seconds since the run's start; None where all of it is meant.

    start_s : of the run, seconds after Monday 00:00
    A clock is the first such moment of the run, for ``high`` after ``low``. Raises ValueError with every mistake.
    """
    if low is None and high is None:
        return None
    wrong: list[str] = []
    low_s = 0.0 if low is None else _end("--from", low, start_s, horizon_s, 0.0, wrong)
    high_s = horizon_s if high is None else _end("--to", high, start_s, horizon_s, low_s, wrong)
    if not wrong and low_s >= high_s:
        found = f"{clock_words(low_s, start_s)} and {clock_words(high_s, start_s)}"
        wrong.append(f"--from and --to: found {found}, expected the later one last")
    if wrong:
        raise ValueError("\n".join(wrong))
    return low_s, high_s


def _end(option: str, text: str, start_s: float, horizon_s: float, after_s: float, wrong: list[str]) -> float:
    """One end of a stretch; what is wrong with it is added to ``wrong``."""
    from opsim.problems import shown

    try:
        at_s = moment_s(text, start_s, after_s)
    except ValueError as error:
        wrong.append(f"{option}: {error}")
        return after_s
    if not 0 <= at_s <= horizon_s:
        found = clock_words(at_s, start_s) if at_s >= 0 else "before the start"
        run = f"{clock_words(0.0, start_s)} to {clock_words(horizon_s, start_s)} ({horizon_s / 3600:.4g} h)"
        wrong.append(f"{option}: found {shown(text)} ({found}), expected a moment of the run, {run}")
        return after_s
    return at_s


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
        from opsim.report.numbers import listing

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
    from opsim.files import whole_file
    from opsim.threads import lean
    from opsim.viewer.build import notes_of
    from opsim.viewer.write import write_replay

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
    from opsim.threads import one_blas_thread
    from opsim.viewer.build import scene_of
    from opsim.viewer.write import packed

    with one_blas_thread():
        told = lambda done, total: report(done, total + 1)  # noqa: E731
        part = packed(scene_of(run, wanted.replication, wanted.window_s, told, like=like))
    report(1, 1)
    return part


def too_large(size: int, low_s: float, high_s: float, at_start_s: float) -> str:
    """What to say of a page of that many bytes: how many hours a page that opens quickly has room for."""

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
