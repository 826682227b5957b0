"""Results that are there of just the run that is asked for: taken as they are, and no row is read again."""

import hashlib
import json
from pathlib import Path
from typing import Any

from opsim.results import events_in
from opsim.study.resolved import STUDIES
from opsim.whole import write_json

FINISHED = "finished.json"
RESULTS = ("summary.json", "kpis.parquet")


def finished(folder: Path, loaded, manifest: dict[str, Any], asks: dict[str, Any]) -> bool:
    """Whether the folder holds the whole results of this run.

    asks : what the run was given beside its scenario file
    True where summary and figures are as they were written, and of each replication there are rows of the same length.
    """
    try:
        held = json.loads((folder / FINISHED).read_text(encoding="utf-8"))
        return held == _says(folder, loaded, manifest, asks, held["events"])
    except (OSError, ValueError, TypeError, KeyError):
        return False


def say_finished(folder: Path, loaded, manifest: dict[str, Any], asks: dict[str, Any], replications: int) -> None:
    """Write of what run the results are; last of all, so that where it is there, the others are. Raises OSError."""
    events = [path.name for path in events_in(folder)[:replications]]
    write_json(folder / FINISHED, _says(folder, loaded, manifest, asks, events))


def _says(folder: Path, loaded, manifest: dict[str, Any], asks: dict[str, Any], events: Any) -> dict[str, Any]:
    made_from = [manifest, {key: block for key, block in loaded.resolved.items() if key != STUDIES}]
    return {
        "run": _sha256(json.dumps([*made_from, sorted(loaded.given), asks]).encode()),
        "results": {name: _sha256((folder / name).read_bytes()) for name in RESULTS},
        "events": {name: (folder / "events" / name).stat().st_size for name in events},
    }


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
