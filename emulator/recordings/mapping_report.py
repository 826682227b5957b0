"""What became of each joint or marker of a file on the way to the canonical skeleton."""

from __future__ import annotations

from dataclasses import dataclass

MOST_NAMED = 6


@dataclass(frozen=True)
class MappedJoint:
    """What became of a joint of the file: ``became`` is "kept", "made", "left out" or "unknown"."""

    name: str
    became: str
    joint: str = ""
    why: str = ""


@dataclass(frozen=True)
class MappingReport:
    """One row for each joint of the file and each joint made."""

    rows: tuple[MappedJoint, ...]

    def of(self, became: str) -> tuple[MappedJoint, ...]:
        """The rows of one kind."""
        return tuple(row for row in self.rows if row.became == became)

    def summary(self) -> str:
        """The numbers of joints of each kind in a sentence, with the names of those that are lost."""
        kinds = ("kept", "made", "left out", "unknown")
        return ", ".join(f"{len(rows)} {kind}{_lost(rows)}" for kind in kinds if (rows := self.of(kind)))


def _lost(rows: tuple[MappedJoint, ...]) -> str:
    """Names of joints that are left out, up to ``MOST_NAMED``."""
    if rows[0].became not in ("left out", "unknown"):
        return ""
    more = f" and {len(rows) - MOST_NAMED} more" if len(rows) > MOST_NAMED else ""
    return f" [{', '.join(row.name or row.joint for row in rows[:MOST_NAMED])}{more}]"
