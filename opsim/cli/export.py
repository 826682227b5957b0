"""What ``opsim export`` is asked for: checked all at once, before anything is read or written.

``opsim export``: results in open formats, and any performance as BVH.

What ``opsim export`` says when it is done.

Any performance of a run as BVH, drawn again as it was: the same body that took the same time.

OCEL 2.0 files, one for each replication of each variant that is asked for.

Event rows or figures of all that is asked for, in one file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.app import mistakes

if TYPE_CHECKING:
    from opsim.plan import Plan

OCEL_JSON, OCEL_SQLITE, PARQUET, CSV, BVH = "ocel-json", "ocel-sqlite", "parquet", "csv", "bvh"
FORMATS = (OCEL_JSON, OCEL_SQLITE, PARQUET, CSV, BVH)
ENDINGS = {
    **dict.fromkeys((".jsonocel", ".json"), OCEL_JSON),
    **dict.fromkeys((".sqlite", ".sqlite3", ".db"), OCEL_SQLITE),
    **{".parquet": PARQUET, ".csv": CSV, ".bvh": BVH},
}
"""Which format an ending means, where nobody says."""
_ROWS, _OCEL = (PARQUET, CSV), (OCEL_JSON, OCEL_SQLITE)
_OF = {
    "worker": (BVH,),
    **dict.fromkeys(("task", "k", "walk", "at", "fps"), (BVH,)),
    "by_task": _OCEL,
    "figures": _ROWS,
    "date": (*_OCEL, *_ROWS),
}
"""Options that belong to some formats alone."""
_NUMBERS = r"[0-9]{1,7}(-[0-9]{1,7})?(,[0-9]{1,7}(-[0-9]{1,7})?)*"


@dataclass(frozen=True)
class Asked:
    """What is to be written: variants by name, and of each the replications; options : the others, as they were said"""

    out: Path
    form: str
    variants: Mapping[str, Any]
    replications: tuple[int, ...]
    options: Mapping[str, Any]


def asked(
    results: Path, out: Path, form: str | None, scenarios: Sequence[str], said: str | None, **options: Any
) -> Asked:
    """Raises ValueError with everything that is wrong, OSError where the results cannot be read."""
    from opsim.cli.report import over_results
    from opsim.results import lacking_rows, variants_in

    held = variants_in(results)
    wrong: list[str] = []
    form = form or ENDINGS.get(out.suffix.lower(), "")
    if not form:
        wrong.append(f"{out}: found the ending {out.suffix!r}, expected one of {', '.join(ENDINGS)}; or say --format")
    wrong += _strange(form, options)
    variants = _variants(held, scenarios, wrong)
    gone = [] if options["figures"] else [words for name in variants if (words := lacking_rows(held[name]))]
    wrong += gone
    replications = () if gone else _replications(held, variants, said, form, wrong)
    if form == BVH:
        wrong += _one_performance(variants, replications, options)
    if options["figures"] and said is not None:
        wrong.append("--figures are of all replications: leave --replication out")
    wrong += _monday(options["date"])
    wrong += over_results(out, held)
    if out.is_dir():
        wrong.append(f"{out}: found a folder, expected a file to write")
    if wrong:
        raise ValueError("\n".join(wrong))
    return Asked(out, form, {name: held[name] for name in variants}, replications, options)


def _strange(form: str, options: Mapping[str, Any]) -> list[str]:
    """Options that were given and are of other formats, in words."""
    given = [name for name in _OF if options.get(name) not in (None, False)]
    return [
        f"--{name.replace('_', '-')} is for {' and '.join(_OF[name])}, not for {form}"
        for name in given
        if form and form not in _OF[name]
    ]


def _variants(held: Mapping[str, Any], scenarios: Sequence[str], wrong: list[str]) -> list[str]:
    from opsim.problems import did_you_mean, shown

    for name in scenarios:
        if name not in held:
            hint = did_you_mean(name, held, otherwise="there are")
            wrong.append(f"--scenario {shown(name)}: no such results; {hint}")
    return [name for name in held if not scenarios or name in scenarios]


def _replications(
    held: Mapping[str, Any], variants: list[str], said: str | None, form: str, wrong: list[str]
) -> tuple[int, ...]:
    """Those asked for; by default the first of what is a log of its own, all of what goes into one table."""
    most = min((len(held[name].events_files) for name in variants), default=0)
    if said is None:
        return (0,) if form in (*_OCEL, BVH) else ()
    if said == "all":
        return tuple(range(most)) if form in (*_OCEL, BVH) else ()
    if not re.fullmatch(_NUMBERS, said):
        wrong.append(f"--replication {said!r}: found no number, expected such as 3, 0-4, 0,2,5 or all")
        return ()
    found = sorted({n for part in said.split(",") for n in _range(part)})
    if not found or found[-1] >= most:
        wrong.append(f"--replication {said}: found none such, expected numbers from 0 to {most - 1}")
        return ()
    return tuple(found)


def _range(part: str) -> range:
    first, _, last = part.partition("-")
    return range(int(first), int(last or first) + 1)


def _monday(date: str | None) -> list[str]:
    from opsim.export.tables import monday_of

    try:
        if date is not None:
            monday_of(date)
    except ValueError as error:
        return [str(error)]
    return []


def _one_performance(variants: list[str], replications: tuple[int, ...], options: Mapping[str, Any]) -> list[str]:
    """What speaks against there being one performance to write."""
    wrong = []
    if len(variants) > 1:
        wrong.append(f"found several variants ({', '.join(variants)}), expected one for a .bvh: say --scenario")
    if len(replications) > 1:
        wrong.append("found several replications, expected one for a .bvh")
    if options["worker"] is None:
        wrong.append("found no --worker, expected whose performance it is")
    ways = [name for name in ("task", "walk", "at") if options[name] not in (None, False)]
    if len(ways) != 1:
        found = " and ".join(f"--{name}" for name in ways) or "none"
        wrong.append(f"found {found}, expected one of --task TASK --k N, --walk --k N, --at TIME")
    elif ways == ["at"] and options["k"] is not None:
        wrong.append("--k is for --task and --walk: --at says which by its time")
    return wrong


@click.command("export")
@click.argument("results", type=click.Path(path_type=Path))
@click.option("-o", "--out", required=True, type=click.Path(path_type=Path), help="The file; by its ending a format.")
@click.option("--format", "form", type=click.Choice(FORMATS), help="The format, where the ending does not say it.")
@click.option(
    "--scenario", "scenarios", multiple=True, metavar="NAME", help="A variant; may be given again.  [default: all]"
)
@click.option("--replication", metavar="N", help="Such as 3, 0-4, or all.  [default: 0 for OCEL and BVH, else all]")
@click.option("--figures", is_flag=True, help="The figures of each replication instead of the events (Parquet, CSV).")
@click.option("--date", metavar="MONDAY", help="The Monday the run's week begins with.  [default: 2026-01-05]")
@click.option("--by-task", is_flag=True, help="OCEL: work is an event type for each task.")
@click.option("--worker", metavar="NAME", help="BVH: whose performance.")
@click.option("--task", metavar="NAME", help="BVH: of this task, the --k-th.")
@click.option("--walk", is_flag=True, help="BVH: the --k-th walk instead.")
@click.option("--k", type=click.IntRange(min=0), help="BVH: which one of the worker's, from 0.  [default: 0]")
@click.option("--at", metavar="TIME", help="BVH: instead what is performed then: 'Tue 10:15:30', '95 min'.")
@click.option("--fps", type=click.FloatRange(min=1, max=1000), help="BVH: frames a second.  [default: 60]")
@click.option("--json", "as_json", is_flag=True, help="JSON for machines.")
def command(
    results: Path,
    out: Path,
    form: str | None,
    scenarios: tuple[str, ...],
    replication: str | None,
    as_json: bool,
    **how: Any,
) -> None:
    """Write the RESULTS of a run for other programs.

    \b
    .jsonocel .json  OCEL 2.0, an object-centric event log (process mining), as JSON
    .sqlite          OCEL 2.0 as an SQLite database
    .parquet .csv    the event rows of all replications, or with --figures every figure
    .bvh             one performance, for programs of animation and motion capture

    OCEL is of one replication of one variant: of several, each gets a file of its own, with its name before the ending.
    In CSV files, text that a spreadsheet would take for a formula begins with an apostrophe.
    """
    from opsim.cli.app import print_json

    with mistakes():
        wanted = asked(results, out, form, scenarios, replication, **how)
        if wanted.form == BVH:
            told = export_bvh(wanted)
        elif wanted.form in (PARQUET, CSV):
            told = export_rows(wanted)
        else:
            told = export_ocel(wanted)
    if as_json:
        print_json(told.plain)
    else:
        for line in told.lines:
            click.echo(line)


@dataclass(frozen=True)
class Told:
    """lines : for people; plain : for machines"""

    lines: tuple[str, ...]
    plain: dict[str, Any]


def size(n_bytes: int) -> str:
    """A file's size in words."""
    return f"{n_bytes / 1e6:.1f} MB" if n_bytes >= 1e5 else f"{n_bytes / 1e3:.1f} kB"


FPS = 60.0


def export_bvh(asked: Asked) -> Told:
    """Write it. Raises ValueError where there is none such, or where it has no body."""
    from emulator.recordings.bvh_write import write_bvh
    from emulator.recordings.take import Take
    from opsim.clock import clock_words
    from opsim.files import whole_file
    from opsim.study.run import reopened

    (result,) = asked.variants.values()
    run = reopened(result.folder)
    log = run.log(asked.replications[0])
    which = _which(asked, log, run.plan)
    fps = asked.options["fps"] or FPS
    positions_m, skeleton, what = (_walked if which.walk else _performed)(log, run.plan, which, fps)
    worker, start_s = asked.options["worker"], float(log["start_s"][which.rows[0]])
    take = Take(skeleton.names, skeleton.parents, positions_m, fps, worker=worker, trial=f"k{which.k}")
    with whole_file(asked.out) as temporary:
        write_bvh(take, temporary)
    begins = clock_words(start_s, run.plan.start_s)
    plain = {
        "out": str(asked.out),
        "worker": worker,
        "what": what,
        "k": which.k,
        "replication": log.replication,
        "start_s": start_s,
        "begins": begins,
        "frames": len(positions_m),
        "fps": fps,
    }
    words = f"{worker}, {what} {which.k}, from {begins} on: {len(positions_m)} frames at {fps:g} a second"
    return Told((f"{asked.out}: {words}, {size(asked.out.stat().st_size)}",), plain)


def _which(asked: Asked, log: Any, plan: Plan) -> Any:
    from opsim.export.tables import at_time, performance_of, run_s, walk_of

    how = asked.options
    if how["at"] is not None:
        return at_time(log, plan, how["worker"], run_s(how["at"], plan.start_s, log.horizon_s))
    if how["walk"]:
        return walk_of(log, plan, how["worker"], how["k"] or 0)
    return performance_of(log, plan, how["worker"], how["task"], how["k"] or 0)


def _performed(log: Any, plan: Plan, which: Any, fps: float) -> tuple[Any, Any, str]:
    """(joints (T, J, 3), skeleton, what): all pieces as one, from where the worker began to where he left off."""
    from opsim.ergonomics.redraw import performance_again

    first = performance_again(log, plan, int(which.rows[0]))
    whole = replace(first, progress_to=float(log["progress_to"][which.rows[-1]]))
    if whole.skeleton is None:
        raise ValueError(f"task {whole.task} is a time without a body: there is no movement to write")
    begun_s = whole.progress_from * whole.duration_s
    times_s = begun_s + _frames_s(whole.progress_to * whole.duration_s - begun_s, fps)
    return whole.positions_m(times_s=times_s), whole.skeleton, whole.task


def _walked(log: Any, plan: Plan, which: Any, fps: float) -> tuple[Any, Any, str]:
    """As ``_performed``: a walk straight on, in the time it took."""
    import numpy as np

    from opsim.ergonomics.walking import walk_again
    from opsim.history import walks_of

    if plan.walking is None:
        raise ValueError("walking is time alone in this scenario: there is no movement to write")
    walks = walks_of(log, plan)
    at = int(np.flatnonzero((walks.worker == which.worker) & (walks.k == which.k))[0])
    drawn = walk_again(plan, log.replication, which.worker, which.k, float(walks.distance_m[at]))
    took_s, whole_s = float(walks.end_s[at] - walks.start_s[at]), float(walks.whole_s[at])
    times_s = _frames_s(min(took_s, whole_s), fps) * (drawn.duration_s / whole_s)
    return drawn.decoded("positions_m", times_s=times_s), drawn.block.skeleton, "walk"


def _frames_s(duration_s: float, fps: float) -> Any:
    import numpy as np

    return np.arange(max(2, round(duration_s * fps) + 1)) / fps


def export_ocel(asked: Asked) -> Told:
    """Write them, one after the other: no more than one replication is in the memory."""
    from opsim.cli.app import printable
    from opsim.cli.progress import progress
    from opsim.study.run import reopened

    written: list[dict[str, Any]] = []
    total = len(asked.variants) * len(asked.replications)
    with progress("export") as report:
        for variant, result in asked.variants.items():
            run = reopened(result.folder)
            for replication in asked.replications:
                if total > 1:
                    report(len(written), total, variant)
                path = _path(asked, variant, replication)
                made = _write(asked, run, replication, path)
                written.append({"variant": variant, "replication": replication, **made})
        if total > 1:
            report(total, total)
    lines = [
        printable(f"{one['out']}: {one['events']:,} events, {one['objects']:,} objects, {size(one['bytes'])}")
        for one in written
    ]
    return Told(tuple(lines), {"format": asked.form, "files": written})


def _path(asked: Asked, variant: str, replication: int) -> Path:
    from opsim.export.tables import out_for

    several = len(asked.replications) > 1
    return out_for(
        asked.out,
        variant=variant if len(asked.variants) > 1 else "",
        replication=replication if several else None,
    )


def _write(asked: Asked, run: Any, replication: int, path: Path) -> dict[str, Any]:
    from opsim.export.ocel import object_log, write_ocel_json, write_ocel_sqlite
    from opsim.export.tables import MONDAY, RunClock, monday_of

    date = asked.options["date"]
    clock = RunClock(run.plan.start_s, MONDAY if date is None else monday_of(date))
    log = run.log(replication)
    made = object_log(log, run.plan, clock, by_task=asked.options["by_task"])
    (write_ocel_json if asked.form == OCEL_JSON else write_ocel_sqlite)(made, path)
    return {"out": str(path), "events": len(log), "objects": made.n_things, "bytes": path.stat().st_size}


def export_rows(asked: Asked) -> Told:
    """Write them as they lie in the results; DuckDB streams them from file to file."""
    from opsim.cli.app import printable
    from opsim.export.tables import write_figures, write_rows

    if asked.options["figures"]:
        n = write_figures({name: result.kpis_file for name, result in asked.variants.items()}, asked.out, asked.form)
    else:
        files = {name: _files(result, asked.replications) for name, result in asked.variants.items()}
        n = write_rows(files, asked.out, asked.form, _clocks(asked))
    what, n_bytes = "figures" if asked.options["figures"] else "rows", asked.out.stat().st_size
    line = printable(f"{asked.out}: {n:,} {what} of {', '.join(asked.variants)}, {size(n_bytes)}")
    plain = {"format": asked.form, "out": str(asked.out), "variants": list(asked.variants), what: n, "bytes": n_bytes}
    return Told((line,), plain)


def _files(result: Any, replications: tuple[int, ...]) -> list[Path]:
    return [result.events_files[n] for n in replications] if replications else result.events_files


def _clocks(asked: Asked) -> dict[str, Any] | None:
    """Of each variant, where a date is given: the times of the calendar stand in the rows too."""
    from opsim.export.tables import RunClock, monday_of, start_of

    if asked.options["date"] is None:
        return None
    monday = monday_of(asked.options["date"])
    return {name: RunClock(start_of(result.summary["start"]), monday) for name, result in asked.variants.items()}
