"""The folder of a study: one study only, gone on with after whatever ended it, and one writer to each journal."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from opsim.files import write_text
from opsim.problems import ScenarioError
from opsim.study.jobs.answers import Answers
from opsim.study.jobs.header import (
    HEADER,
    EnginesFile,
    Header,
    NotAStudy,
    differing,
    files_in,
    read_header,
    write_header,
)
from opsim.study.jobs.job import Shard
from opsim.study.jobs.journal import Journal
from opsim.study.resolved_scenario import differences, read_resolved, resolved_text
from opsim.study.results_folder import locked

ANSWERS, ALL, RESOLVED = "answers", "all.jsonl", "scenario.resolved.yaml"
RESULTS = ("summary.json", "figures.parquet")
MOST_DIFFERENCES = 5
FEW = 10
"""Answers of a study that turned out to ask for something that is not there, such as a figure: not worth keeping where
its folder would then refuse what was meant."""
WAIT_S = 20.0
"""For so long another process may be at the header of a folder that several shards share."""


class OtherStudy(ValueError):
    """The folder holds something else, which is neither mixed with nor deleted unasked."""


@dataclass(frozen=True)
class StudyFolder:
    """A folder that this process writes to; ``header`` says what is asked, ``journal`` holds the answers."""

    path: Path
    header: Header
    journal: Journal
    shard: Shard | None = None
    keep: tuple[str, ...] = ()

    def answers(self, **how: Any) -> Answers:
        """The study's answers, kept in the folder; ``how`` : processes, executor, progress, compute, engine, chosen."""
        own = self.path / ANSWERS / (ALL if self.shard is None else self.shard.file)
        how["chosen"] = EnginesFile(own, _journals(self.path) if self.shard is None else [own], how.get("chosen"))
        return Answers(self.header.source, self.journal, shard=self.shard, keep=self.keep, **how)


@contextmanager
def open_study(
    folder: Path,
    header: Header,
    resolved: Mapping[str, Any] | None = None,
    *,
    shard: Shard | None = None,
    overwrite: bool = False,
) -> Iterator[StudyFolder]:
    """Go on with a study in a folder, or begin it there.

    resolved : the scenario to start from as plain values, kept so that it can be said in what another one differs
    Raises OtherStudy where the folder holds something else, Busy where somebody writes the same answers now, OSError.
    """
    _refuse(folder, header, resolved, overwrite)
    answers = _made(folder)
    journal = ALL if shard is None else shard.file
    with ExitStack() as until_closed:
        with _beginning(folder):
            _refuse(folder, header, resolved, overwrite)
            if overwrite:
                _empty(folder)
            until_closed.enter_context(_writing(answers / journal))
            begun = not (folder / HEADER).exists()
            keep = _begin(folder, header, resolved)
            (answers / journal).touch()
        others = [path for path in sorted(answers.glob("*.jsonl")) if path.name != journal]
        opened = Journal(others, answers / journal)
        until_closed.callback(opened.close)
        try:
            yield StudyFolder(folder, header, opened, shard, keep)
        except BaseException as error:
            refused = isinstance(error, ValueError | ScenarioError)
            if begun and len(opened) <= (FEW if refused else 0):
                with _beginning(folder):
                    _forget(folder, answers / journal)
            raise


def other_study(folder: Path, header: Header, resolved: Mapping[str, Any] | None = None) -> str | None:
    """What the folder holds and in what it differs from a study, in words; None where the study may go on there."""
    if folder.exists() and not folder.is_dir():
        return f"{folder} is a file, not a folder"
    if holds_run(folder):
        return f"{folder} holds results of 'opsim run'"
    if not (folder / HEADER).exists():
        return f"{folder} holds a study that is not known (it has no {HEADER})" if _journals(folder) else None
    try:
        held = read_header(folder)
    except NotAStudy as error:
        return str(error)
    if not (differ := differing(held, header)):
        return None
    differ = [text for one in differ for text in (_of_scenario(folder, resolved) if one == "the scenario" else [one])]
    more = f" and {len(differ) - MOST_DIFFERENCES} more" if len(differ) > MOST_DIFFERENCES else ""
    what = f"a {held.kind} study of {held.made_from.get('scenario')!r}"
    return f"{folder} holds {what}; not the same: {'; '.join(differ[:MOST_DIFFERENCES])}{more}"


def holds_run(folder: Path) -> bool:
    """Whether a folder holds results of ``opsim run``, of one variant or of several."""
    if (folder / "manifest.json").exists() or any(folder.glob("*/manifest.json")):
        return True
    return (folder / "summary.json").exists() and not (folder / HEADER).exists()


def holds_study(folder: Path) -> bool:
    """Whether a folder is that of a study."""
    return (folder / HEADER).exists() or bool(_journals(folder))


def _refuse(folder: Path, header: Header, resolved: Mapping[str, Any] | None, overwrite: bool) -> None:
    words = other_study(folder, header, resolved)
    if words is None:
        return
    removable = holds_study(folder) and not holds_run(folder)
    if not (overwrite and removable):
        way_out = "take another folder with -o" + (", or --overwrite to remove what is there" if removable else "")
        raise OtherStudy(f"{words}\n{way_out}")


def _made(folder: Path) -> Path:
    """The folder of its journals, made where it is not there. Raises OSError."""
    answers = folder / ANSWERS
    answers.mkdir(parents=True, exist_ok=True)
    return answers


def _beginning(folder: Path) -> AbstractContextManager[None]:
    return locked(folder / ANSWERS / ".study.lock", f"{folder}: another run is about to begin here", WAIT_S)


def _writing(journal: Path) -> AbstractContextManager[None]:
    busy = f"{journal.parent.parent}: another run writes to {journal.name} now"
    words = f"{busy}; wait for it, or take another folder with -o"
    return locked(journal.with_name(f".{journal.name}.lock"), words)


def _empty(folder: Path) -> None:
    """Remove results first, then answers, the header last: what is left half-way is never a summary without answers."""
    with ExitStack() as all_of_them:
        for journal in _journals(folder):
            all_of_them.enter_context(_writing(journal))
        _remove_results(folder)
        for journal in _journals(folder):
            journal.unlink(missing_ok=True)
        for path in (*files_in(folder), folder / HEADER):
            path.unlink(missing_ok=True)


def _forget(folder: Path, journal: Path) -> None:
    """Remove a study that was stopped at its beginning, unless another shard of it has begun too."""
    if _journals(folder) != [journal]:
        return
    for path in (journal, folder / RESOLVED, *files_in(folder), folder / HEADER):
        path.unlink(missing_ok=True)


def _begin(folder: Path, header: Header, resolved: Mapping[str, Any] | None) -> tuple[str, ...]:
    """Write what is asked; the figures that are kept, which may be more than this time's."""
    held = read_header(folder) if (folder / HEADER).exists() else None
    keep = header.source.kpis if held is None else held.source.kpis
    kept = replace(header, source=replace(header.source, kpis=keep))
    if held is None or held.plain() != kept.plain():
        _remove_results(folder)
        if resolved is not None:
            write_text(folder / RESOLVED, resolved_text(dict(resolved)))
        write_header(kept, folder)
    return keep


def _remove_results(folder: Path) -> None:
    for path in [*(folder / name for name in RESULTS), *folder.glob("*.html")]:
        path.unlink(missing_ok=True)


def _journals(folder: Path) -> list[Path]:
    return sorted((folder / ANSWERS).glob("*.jsonl"))


def _of_scenario(folder: Path, resolved: Mapping[str, Any] | None) -> list[str]:
    """The scenario's differences path by path, where both are known."""
    try:
        held = read_resolved((folder / RESOLVED).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        held = {}
    return (differences(held, dict(resolved)) if held and resolved else []) or ["the scenario"]
