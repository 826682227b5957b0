"""A study from its verb to its files: opened or gone on with, computed, told; what may stop it is said in words.

A study told on a terminal: its answer, the tables that fit on one screen, and where the page is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import click

from opsim.cli.app import mistakes
from opsim.cli.progress import telling
from opsim.cli.study_options import Asked, Common, Kind, Told, from_here
from opsim.engine import FAST, SIMPY

MOST_SAID = 5


def run_study(kind: Kind, file: str, common: Common, options: Mapping[str, Any]) -> None:
    """Everything that a verb does: options are laid over the scenario's block, the study is computed and told.

    options : keys of the kind's block -> plain values; None, () or False where nothing was said
    """
    from opsim.cli.app import stops_once
    from opsim.cli.study_options import asked_by_user, header_for
    from opsim.threads import lean

    lean()
    with stops_once():
        with mistakes():
            shard = _shard(kind, common)
            asked = asked_by_user(kind, from_here(file), common, options)
            _refuse_engine(asked, common.engine)
            header = header_for(kind, asked, common.words, common.replications)
            out = common.out or Path("results") / f"{asked.varied.file.stem}_{kind.name.replace('-', '_')}"
        how = {
            "shard": shard,
            "overwrite": common.overwrite,
            "processes": common.processes,
            "executor": common.executor,
            "engine": common.engine,
        }
        told = computed(kind, asked, header, out, **how)
    if told is not None:
        show(kind, told, out, common.as_json)


def computed(
    kind: Kind,
    asked: Asked,
    header: Any,
    out: Path,
    *,
    shard: Any = None,
    overwrite: bool = False,
    processes: int | None = None,
    executor: str | None = None,
    engine: str = SIMPY,
) -> Told | None:
    """The study told, and all its files written; None of a shard, of which is said what to do next."""
    from opsim.study.jobs.executors import executor_of
    from opsim.study.jobs.folder import open_study
    from opsim.study.jobs.job import ShardDone

    resolved = asked.loaded.resolved
    with (
        _stopping(out),
        mistakes(),
        executor_of(executor) as by,
        open_study(out, header, resolved, shard=shard, overwrite=overwrite) as study,
    ):
        said_damaged(study.journal)
        try:
            with (
                _reporting(kind) as report,
                closing(_answers(study, report, kind, processes=processes, executor=by, engine=engine)) as all_of_it,
            ):
                told = kind.study(asked, all_of_it)
                write_study(kind, asked, told, all_of_it, out)
            return told
        except ShardDone as done:
            click.echo(_next(done, shard, out))
            return None


def _answers(study: Any, report: Any, kind: Kind, **how: Any) -> Any:
    return study.answers(progress=report, chosen=telling(kind.name, report), **how)


def _refuse_engine(asked: Asked, engine: str) -> None:
    """What the fast engine does not run of the scenario, before there is a folder. Raises ScenarioError."""
    from opsim.plan import compile_plan
    from opsim.study.engine_choice import engine_of

    if engine == FAST:
        engine_of(engine, asked.loaded, compile_plan(asked.loaded, seed=asked.source.seed))


def write_study(kind: Kind, asked: Asked, told: Told, answers: Any, out: Path) -> None:
    """Write figures.parquet, the page, and summary.json last: where it is, the others are. Raises OSError."""
    from opsim import __version__
    from opsim.files import write_json
    from opsim.report.page import write_study_page
    from opsim.study.jobs.merge import write_figures

    scenario = asked.loaded.scenario
    head = {
        "opsim": __version__,
        "study": kind.name,
        "scenario": scenario.name,
        "variant": asked.variant,
        "file": asked.varied.file.name,
        "seed": scenario.run.seed if asked.source.seed is None else asked.source.seed,
        "jobs": len(answers.asked),
    }
    write_figures(answers, out / "figures.parquet")
    write_study_page(told.page, page_of(kind, out))
    write_json(out / "summary.json", {**head, **told.summary})


def show(kind: Kind, told: Told, out: Path, as_json: bool) -> None:
    """One screen, or JSON: what stands in summary.json, and where things are."""
    import json

    from opsim.cli.app import print_json

    if as_json:
        summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
        print_json({"folder": str(out), "page": str(page_of(kind, out)), "summary": summary})
    else:
        print_study(told.page, page_of(kind, out))


def said_damaged(journal: Any) -> None:
    """Warn of lines of a journal that are not what was written."""
    for place in journal.damaged[:MOST_SAID]:
        click.echo(f"warning: {place} is damaged; what stood there counts as not there", err=True)
    if len(journal.damaged) > MOST_SAID:
        click.echo(f"warning: and {len(journal.damaged) - MOST_SAID} lines more", err=True)


def page_of(kind: Kind, out: Path) -> Path:
    """Where the page of a study is."""
    return out / f"{kind.name.replace('-', '_')}.html"


def _shard(kind: Kind, common: Common) -> Any:
    from opsim.study.jobs.job import Shard

    if common.shard is None:
        return None
    if kind.no_shards:
        raise ValueError(f"--shard: {kind.no_shards}")
    return Shard.read(common.shard)


@contextmanager
def _stopping(out: Path) -> Iterator[None]:
    from opsim.cli.app import stopped
    from opsim.cli.run_variants import failures

    kept = f"finished replications are kept in {out}; the same command goes on from there"
    try:
        with failures(kept):
            yield
    except KeyboardInterrupt as stop:
        raise stopped(stop, kept) from None


@contextmanager
def _reporting(kind: Kind) -> Iterator[Any]:
    from opsim.cli.progress import progress

    with progress(kind.name) as report:
        yield report


def _next(done: Any, shard: Any, out: Path) -> str:
    head = f"shard {shard}: {done.mine} of {done.of} replications are in {out}"
    if done.left == 0:
        return f"{head}, and so are all others: 'opsim merge {out}' makes the summary"
    return f"{head}; when all {shard.of} are done, 'opsim merge FOLDER... -o OUT' with their folders makes the summary"


def print_study(page: Any, path: Path | None) -> None:
    """page : a StudyPage; path : where it was written, None where it was not."""
    from opsim.cli.app import print_table, printable

    click.echo(printable(f"{page.title}: {page.kind}"))
    for sentence in page.answer:
        click.echo(printable(sentence))
    for section in page.sections:
        if section.on_screen:
            _print_section(section, print_table, printable)
    if path is not None:
        click.echo(f"{page.kind}: {path}")


def _print_section(section: Any, print_table: Any, printable: Any) -> None:
    click.echo()
    if section.table is None:
        click.echo(printable(section.title))
    else:
        print_table(section.title, section.table.columns, section.table.rows, words=section.table.words)
    for sentence in section.sentences:
        click.echo(printable(sentence))
    for line in section.code.splitlines():
        click.echo(printable(line))
