"""A results folder as one frozen thing."""

import json
from dataclasses import dataclass
from pathlib import Path

Key = tuple[str, str, str, str]
"""(kpi, subject, part, unit)"""


@dataclass(frozen=True)
class Result:
    """What a run left: ``summary`` is the content of summary.json; the rows are in ``events/``."""

    folder: Path
    summary: dict

    @classmethod
    def load(cls, folder: Path) -> "Result":
        """Read a results folder. Raises OSError or ValueError where it is none."""
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        if not isinstance(summary, dict) or not {"seed", "kpis", "replications"} <= summary.keys():
            raise ValueError(f"{folder / 'summary.json'}: not the summary of a run")
        return cls(folder, summary)

    @property
    def events_files(self) -> list[Path]:
        """Parquet files of the rows, a replication each."""
        return sorted((self.folder / "events").glob("replication_*.parquet"))[: self.summary["replications"]]

    def kpis(self) -> dict[Key, dict[int, float]]:
        """Every figure by replication; nan where nothing was observed. Raises OSError where it cannot be read."""
        from opsim.log_store import connect, plain_errors, quoted

        path = self.folder / "kpis.parquet"
        with plain_errors(path), connect() as connection:
            rows = connection.execute(
                "SELECT kpi, subject, part, unit, replication, coalesce(value, 'nan'::DOUBLE) "
                f"FROM read_parquet({quoted(str(path))}) ORDER BY replication"
            ).fetchall()
        found: dict[Key, dict[int, float]] = {}
        for *key, replication, value in rows:
            found.setdefault(tuple(key), {})[replication] = value  # type: ignore[arg-type]
        return found


def variants_in(folder: Path) -> dict[str, Result]:
    """The results of each variant of a run by name; the folder may also be that of one variant.

    Raises ValueError where it holds no results, OSError where they cannot be read.
    """
    if (folder / "summary.json").is_file():
        return {folder.name: Result.load(folder)}
    found = {path.parent.name: Result.load(path.parent) for path in sorted(folder.glob("*/summary.json"))}
    if not found:
        raise ValueError(f"{folder}: no results here; 'opsim run FILE.yaml -o {folder}' makes some")
    return found
