"""A stamp of the engine's sources: what was compiled from others is never taken for theirs.

numba's files on disk know of changes of the file that a function stands in, and of no other: a step that reads a field
of a struct, or calls another step, must be compiled anew when that one changes. So the stamp stands in every type.
"""

from __future__ import annotations

from functools import cache
from hashlib import blake2b
from os import environ
from os.path import relpath
from pathlib import Path

ENGINE = Path(__file__).parents[1]
OPSIM = ENGINE.parents[1]
COMPILED_TOO = (ENGINE.parent, OPSIM / "human", OPSIM / "plan", OPSIM / "ergonomics" / "kernels")
SINGLE = (OPSIM / "clock.py", OPSIM / "log.py", OPSIM / "posts.py", OPSIM / "streams.py")
"""Whose functions are compiled into steps as they are written, or whose constants are, such as kinds of rows."""
SEEN_FROM_PYTHON = (
    *("arena.py", "calling.py", "linking.py", "sharing_out.py", "slow.py", "stamp.py", "store.py", "table.py"),
    "__init__.py",
)
"""Nothing of these is compiled."""


def sources() -> list[Path]:
    """The files that count; fewer, where ``OPSIM_STAMP=parts`` says so, to work on one file."""
    fewer = environ.get("OPSIM_STAMP") == "parts"
    folders = (ENGINE / "machine", ENGINE / "parts") if fewer else COMPILED_TOO
    found = [path for folder in folders for path in folder.rglob("*.py")]
    here = {ENGINE / "machine" / name for name in SEEN_FROM_PYTHON}
    return sorted(path for path in (*found, *(() if fewer else SINGLE)) if path not in here)


@cache
def stamp_of(path: str) -> str:
    """Of what stands in a file when it is first asked for; nothing where it cannot be read.

    NOTE: times would be quicker, but an image or an archive may give two versions of a file the same time, and one
    version two times.
    """
    try:
        return blake2b(Path(path).read_bytes(), digest_size=16).hexdigest()
    except OSError:
        return ""


def _stamp() -> str:
    """Of names and contents of the sources."""
    told = [f"{relpath(path, OPSIM)} {stamp_of(str(path))}" for path in sources()]
    return blake2b("\n".join(told).encode(), digest_size=8).hexdigest()


STAMP = _stamp()
