"""A results folder as one frozen thing."""

import json
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Result:
    """What a run left: ``summary`` is the content of summary.json; the rows are in ``events/``."""

    folder: Path
    summary: dict

    @classmethod
    def load(cls, folder: Path) -> "Result":
        """Read a results folder. Raises OSError or ValueError where it is none."""
        return cls(folder, json.loads((folder / "summary.json").read_text(encoding="utf-8")))

    @property
    def events_files(self) -> list[Path]:
        """Parquet files of the rows, a replication each."""
        return sorted((self.folder / "events").glob("replication_*.parquet"))[: self.summary["replications"]]
