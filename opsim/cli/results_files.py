"""What ``report``, ``view``, ``export`` and ``sql`` may not write over: the files that results are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any


def wrong_page(out: Path, held: Mapping[str, Any]) -> list[str]:
    """What keeps a page from being written; held : the Results that lie around. Its folder is made."""
    from opsim.cli.motion_files import ready

    try:
        ready(out, ".html")
    except ValueError as error:
        return [str(error)]
    return over_results(out, held)


def over_results(out: Path, held: Mapping[str, Any]) -> list[str]:
    """That ``out`` is a file of the results, by whatever path, in words."""
    from opsim.cli.motion_files import overwritten

    return overwritten(out, result=[file for result in held.values() for file in files_of(result)])


def files_of(result: Any) -> list[Path]:
    """The files that a variant's results are."""
    from opsim.results import events_in
    from opsim.study.finished import FINISHED
    from opsim.study.folder import MANIFEST, RESOLVED

    named = (result.folder / name for name in (MANIFEST, RESOLVED, "summary.json", FINISHED))
    return [result.kpis_file, *named, *events_in(result.folder)]
