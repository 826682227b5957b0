"""Executors by a name that stands on a command line."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager


@contextmanager
def executor_of(text: str | None) -> Iterator[Executor | None]:
    """``dask:tcp://host:8786`` -> an executor on that cluster; None: this machine. Raises ValueError, OSError."""
    if text is None:
        yield None
        return
    kind, _, address = text.partition(":")
    if kind != "dask" or not address:
        raise ValueError(f"--executor: expected dask:ADDRESS, such as dask:tcp://host:8786, found {text[:60]!r}")
    from opsim.study.jobs.dask_cluster import cluster

    with cluster(address) as executor:
        yield executor
