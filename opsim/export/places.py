"""Where each of several files goes that one name was given for."""

from __future__ import annotations

from pathlib import Path


def out_for(out: Path, *, variant: str = "", replication: int | None = None) -> Path:
    """``out``, with the variant and the replication before its ending where there are several.

    A variant is the name of its results folder, and so of a file: it leads nowhere else.
    """
    said = [variant] if variant else []
    said += [f"r{replication:05d}"] if replication is not None else []
    return out.with_name("_".join([out.stem, *said]) + out.suffix)
