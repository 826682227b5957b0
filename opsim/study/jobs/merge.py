"""Folders of one study put together: first all is checked, then something is written.

``figures.parquet``: every figure of every replication that a study asked for, in an order of its own.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from opsim.log_parquet import ROW_GROUP, parquet_file
from opsim.scenario.variants import flow_text
from opsim.study.jobs.answers import Answers
from opsim.study.jobs.folder import ANSWERS, OtherStudy
from opsim.study.jobs.header import HEADER, Header, differing, read_header
from opsim.study.jobs.job import Answer, Job, Missing, Shard
from opsim.study.jobs.journal import Journal

MOST_SHOWN = 8


def one_header(folders: Sequence[Path]) -> Header:
    """The header that all folders have. Raises OtherStudy with every folder that holds another study, or none."""
    headers = {folder: _header(folder) for folder in folders}
    first, *others = headers
    wrong = []
    for folder in others:
        differ = differing(headers[first], headers[folder]) or _asked_differ(headers[first], headers[folder])
        if differ:
            wrong.append(f"{folder} is not of the same study as {first}: {'; '.join(differ)}")
    if wrong:
        raise OtherStudy("\n".join(wrong))
    return headers[first]


def journals_of(folders: Sequence[Path]) -> list[Path]:
    """Every file of answers in the folders."""
    return [path for folder in dict.fromkeys(folders) for path in sorted((folder / ANSWERS).glob("*.jsonl"))]


def one_journal(files: Sequence[Path]) -> Journal:
    """All answers of some files, to be read. Raises OSError, OtherStudy where two give the same job other answers."""
    joined = Journal(files)
    if joined.twice:
        joined.close()
        raise OtherStudy(
            f"two files give other answers to the same replication: {'; '.join(joined.twice[:MOST_SHOWN])}"
        )
    return joined


def copy_answers(answers: Answers, before: Journal, to: Journal) -> None:
    """Every answer that was asked for goes where it is not yet. Raises OSError."""
    for address in answers.addresses():
        if address not in to:
            keys = json.dumps([list(key) for key in before.keys(address)], ensure_ascii=False)
            to.add(address, Answer(keys, tuple(before.values(address))))


def missing_words(missing: Missing, header: Header, folders: Sequence[Path], files: Sequence[Path]) -> str:
    """What is missing, and the commands that make it."""
    shards = {shard: path for path in files if (shard := Shard.of_file(path.name)) is not None}
    lacking = f"{len(missing.places)} of {missing.of} replications are missing"
    counts = {shard.of for shard in shards}
    if len(counts) != 1:
        return f"{lacking}; this makes them:\n  {header.command} -o {folders[0]}"
    of = counts.pop()
    lines = []
    for number, lost in sorted(Counter(place % of + 1 for place in missing.places).items()):
        shard = Shard(number, of)
        there = "is not there" if shard not in shards else f"is not finished, {lost} of its replications are missing"
        folder = shards[shard].parent.parent if shard in shards else folders[0]
        lines.append(f"shard {shard} {there}; this makes it:\n  {header.command} --shard {shard} -o {folder}")
    more = [f"and {len(lines) - MOST_SHOWN} shards more"] if len(lines) > MOST_SHOWN else []
    return "\n".join([lacking, *lines[:MOST_SHOWN], *more])


def _header(folder: Path) -> Header:
    if not (folder / HEADER).is_file():
        raise OtherStudy(f"{folder}: no study here (no {HEADER}); the folders of its shards are wanted")
    return read_header(folder)


def _asked_differ(first: Header, other: Header) -> list[str]:
    """In words, what was asked otherwise: the jobs of a shard are counted in what was asked."""
    words = []
    if first.replications != other.replications:
        words.append(f"replications {first.replications or 'as the file says'}, there {other.replications}")
    before, now = dict(first.asked), dict(other.asked)
    words += [
        f"{key} {flow_text(before.get(key))}, there {flow_text(now.get(key))}"
        for key in {**before, **now}
        if before.get(key) != now.get(key)
    ]
    return words


AT_ONCE = 2_000
"""Replications whose figures are in memory as numbers of Python at a time."""


def write_figures(answers: Answers, path: Path) -> None:
    """Columns point, workforce, replication, kpi, subject, part, unit, value: by point in the order of the first
    asking, workforce, replication, and figure. The same bytes, however they were computed. Raises OSError.
    """
    jobs = answers.asked
    keys = answers.keys(jobs)
    points = {point: number for number, point in enumerate(dict.fromkeys(job.point for job in jobs))}
    jobs = sorted(jobs, key=lambda job: (points[job.point], *job.key[1:]))
    with parquet_file(path) as (connection, temporary):
        names = np.array([point.name for point in points] or [""], dtype=object)
        connection.register("points", {"at": np.arange(len(names)), "name": names})
        columns = np.array([list(key) for key in keys] or [[""] * 4], dtype=object).T
        kinds = dict(zip(("kpi", "subject", "part", "unit"), columns))
        connection.register("kinds", {"at": np.arange(columns.shape[1]), **kinds})
        connection.execute(
            "CREATE TABLE figures "
            "(place BIGINT, point INT, workforce BIGINT, replication BIGINT, kind INT, value DOUBLE)"
        )
        for first in range(0, len(jobs), AT_ONCE):
            some = jobs[first : first + AT_ONCE]
            connection.register("more", _rows(answers, some, first, [points[job.point] for job in some], keys))
            connection.execute("INSERT INTO figures SELECT * FROM more")
        connection.execute(
            "COPY (SELECT points.name AS point, nullif(workforce, -1) AS workforce, replication, "
            "kpi, subject, part, unit, "
            "CASE WHEN isnan(value) THEN NULL ELSE value END AS value "
            "FROM figures JOIN points ON figures.point = points.at JOIN kinds ON figures.kind = kinds.at "
            f"ORDER BY place, kind) TO {temporary} (FORMAT parquet, COMPRESSION zstd, ROW_GROUP_SIZE {ROW_GROUP})"
        )


def _rows(
    answers: Answers, jobs: Sequence[Job], first: int, points: Sequence[int], keys: Sequence[tuple[str, str, str, str]]
) -> dict[str, np.ndarray]:
    """The figures that some jobs have, with the number of their job in the file's order."""
    values = answers.values(jobs, keys)
    row, column = np.nonzero(answers.has(jobs, keys))
    return {
        "place": first + row,
        "point": np.asarray(points)[row],
        "workforce": np.array([job.key[2] for job in jobs])[row],
        "replication": np.array([job.replication for job in jobs])[row],
        "kind": column,
        "value": values[row, column],
    }
