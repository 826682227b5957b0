"""A finished run opened again: its rows, and the plan they came from, so that bodies can be drawn again."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from opsim.results import Result, lacking_rows, read_object
from opsim.study.folder import MANIFEST, RESOLVED
from opsim.study.manifest import digest, manifest_of

NEEDED = {"libraries": "the library", "recorded": "the file"}
"""What a manifest holds the hashes of, in words."""


@dataclass(frozen=True)
class Reopened:
    """A variant's results folder with what it was run from.

    loaded : the variant as its ``scenario.resolved.yaml`` reads, under its own name; manifest : as it was written
    """

    result: Result
    loaded: Any
    manifest: dict[str, Any]

    @cached_property
    def plan(self) -> Any:
        """Compiled with the seed of the run."""
        from opsim.plan import compile_plan

        return compile_plan(self.loaded, seed=self.result.summary["seed"])

    def log(self, replication: int = 0) -> Any:
        """The rows of one replication. Raises ValueError where the run has none such, OSError where it is broken."""
        from opsim.log_store import read_events

        if gone := lacking_rows(self.result):
            raise ValueError(gone)
        files = self.result.events_files
        if not 0 <= replication < len(files):
            raise ValueError(f"replication {replication}: {self.result.folder} holds 0 to {len(files) - 1}")
        return read_events(files[replication], digest(self.manifest))


def opened(result: Result, loaded: Any) -> Reopened:
    """A run that has just ended, as it was read. Raises OSError or ValueError where its manifest cannot be read."""
    return Reopened(result, loaded, _manifest(result.folder))


def reopened(folder: Path) -> Reopened:
    """The results of one variant of a run.

    Raises OSError where a file is missing, ValueError where the folder holds no run, or where a library or a file of
    times is no longer the one it was run with: other bodies would be shown than those whose times were spent.
    """
    from dataclasses import replace

    from opsim.scenario import read_scenarios

    result = Result.load(folder)
    manifest = _manifest(folder)
    loaded = next(iter(read_scenarios(folder / RESOLVED).values()))
    loaded = replace(loaded, variant=result.summary["variant"])
    if changed := _changed(manifest, manifest_of(loaded, result.summary["seed"])):
        raise ValueError(f"{folder}: {'; '.join(changed)} since it was run; run it again, or put back what there was")
    return Reopened(result, loaded, manifest)


def _manifest(folder: Path) -> dict[str, Any]:
    return read_object(folder / MANIFEST, "the manifest of a run")


def _changed(held: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Everything that is not as it was, in words."""
    found = []
    for kind, what in NEEDED.items():
        old, new = held.get(kind) or {}, now[kind]
        found += [f"{what} {name} has changed" for name in {**old, **new} if old.get(name) != new.get(name)]
    return found
