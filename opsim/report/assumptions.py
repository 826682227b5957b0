"""What a run takes as given, and what was checked of it."""

from __future__ import annotations

from opsim.report.material import Material
from opsim.report.section import Block, Bullets, Folded, Grid, Section, Words

SAID = "What this run takes as given. Nothing here was measured by the run."


def section(material: Material) -> Section:
    """The assumption sheet; a topic is written at its first row only."""
    summary = material.summary
    said = [(row["topic"], row["says"]) for row in summary.get("assumptions") or []]
    rows = [("" if i and said[i - 1][0] == topic else topic, says) for i, (topic, says) in enumerate(said)]
    blocks: list[Block] = [Words(SAID), Grid(("Topic", "What is assumed"), rows, "", words=2, said="assumption sheet")]
    if summary.get("checks"):
        blocks.append(Folded("Checked after every replication", [Bullets(summary["checks"])]))
    return Section("assumptions", "Assumption sheet", blocks, "Assumptions")
