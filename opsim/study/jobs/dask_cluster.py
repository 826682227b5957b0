"""A cluster of ``dask.distributed`` as an executor."""

from __future__ import annotations

import logging
import re
import socket
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

CONNECT_S = 10.0
RETRIES = 3
PORT = 8786


class NoCluster(OSError):
    """Nobody answers at the address of a scheduler."""


@contextmanager
def cluster(address: str) -> Iterator[Executor]:
    """An executor on the workers of a scheduler, at ``tcp://host:port``.

    Raises ValueError where dask is not installed or the address is none, NoCluster.
    """
    host, port = _read(address)
    if find_spec("distributed") is None:
        raise ValueError("--executor dask: dask is not installed; 'pip install opsim[cluster]' brings it")
    _answers(address, host, port)
    from distributed import Client

    _quiet()
    client: Any = None
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
        executor: Any = client.get_executor(pure=False, retries=RETRIES)
        executor._max_workers = sum(client.nthreads().values())
    except (OSError, ValueError, TypeError) as error:
        raise NoCluster(f"--executor dask:{address}: what answers there is no scheduler ({_words(error)})") from None
    try:
        yield executor
    finally:
        client.close(timeout=5)


def _quiet() -> None:
    """What fails is said once, by us: a worker that was lost is no news where another one takes its work.

    dask gives some of its loggers levels of their own, which that of ``distributed`` does not reach.
    """
    for name in ("distributed", *logging.root.manager.loggerDict):
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _read(address: str) -> tuple[str, int]:
    """``tcp://host:port`` or ``host:port`` -> host, port. Raises ValueError."""
    found = re.fullmatch(r"(?:(?:tcp|tls|ucx)://)?(\[[0-9a-fA-F:]+\]|[^\s:/\[\]]+):(\d{1,5})", address)
    if not found or not 0 < int(found[2]) < 65_536:
        raise ValueError(
            f"--executor dask:{address[:60]}: expected dask:tcp://HOST:PORT, such as dask:tcp://node1:{PORT}"
        )
    return found[1].strip("[]"), int(found[2])


def _answers(address: str, host: str, port: int) -> None:
    """Raises NoCluster where nobody listens, or somebody else: dask itself would try for long or for ever.

    A scheduler speaks first, unless the connection is encrypted.
    """
    try:
        with socket.create_connection((host, port), CONNECT_S) as connection:
            if not address.startswith("tls:") and not connection.recv(1):
                raise ConnectionError("it hangs up")
    except OSError as error:
        raise NoCluster(f"--executor dask:{address}: no scheduler answers there ({_words(error)})") from None


def _words(error: Exception) -> str:
    said = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return " ".join(said.split())[:160] or type(error).__name__
