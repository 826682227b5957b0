"""``figures.parquet``: every figure of every replication that a study asked for, in an order of its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from opsim.log_store import ROW_GROUP, parquet_file
from opsim.study.jobs.answers import Answers
from opsim.study.jobs.job import Job

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
