"""What stands at the foot of a replay: which run it is, whose movements these are, and what is not drawn from any."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.provenance import behind


def notes_of(summaries: Mapping[str, Mapping[str, Any]], replication: int) -> list[tuple[str, str]]:
    """(topic, words) of the variants that are shown, by name; each as in ``summary.json``."""
    seeds = sorted({summary["seed"] for summary in summaries.values()})
    run = f"replication {replication}, seed {', '.join(map(str, seeds))}: one course of luck, not the average"
    tasks = [row for summary in summaries.values() for row in summary["tasks"]]
    walks = [summary["walking"] for summary in summaries.values() if summary.get("walking")]
    return [
        ("Run", run),
        *_movements([*(row for row in tasks if row.get("emulated")), *walks]),
        *_without_body(tasks),
        ("Licences", "; ".join(_once(row["licence"] for row in [*tasks, *walks] if row.get("licence")) or ["none"])),
    ]


def _movements(rows: list[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Whose movements the people make, each source once with all that was learned from it."""
    said = []
    for source in _once(row["source"] for row in rows):
        learned = {(row["library"], row["library_task"]): row for row in rows if row["source"] == source}.values()
        n_workers = max(row["n_workers"] for row in learned)
        said.append(f"{source} ({behind(source, sum(row['n_sequences'] for row in learned), n_workers)})")
    drawn = "emulated, each performance as the run drew it, from"
    return [("Movements", f"{drawn} {'; '.join(said)}")] if said else []


def _without_body(tasks: list[Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Tasks whose times were spent and whose movements nobody knows."""
    names = _once(row["task"] for row in tasks if not row.get("emulated") and not row.get("automatic"))
    if not names:
        return []
    return [("Without movement", f"{', '.join(names)}: times without a body; who does them is drawn standing")]


def _once(words: Any) -> list[str]:
    return list(dict.fromkeys(words))
