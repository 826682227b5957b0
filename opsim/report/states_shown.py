"""What workers, stations and vehicles were doing: a bar each of shares that sum to 1."""

from __future__ import annotations

from opsim.report import figures
from opsim.report.material import Material
from opsim.report.section import Block, Caution, Chart, Section
from opsim.report.words import quantity

STATE_KPIS = {"worker_states": "Workers", "station_states": "Stations", "transporter_states": "Transporters"}


def section(material: Material) -> Section | None:
    """A figure a kind; where shares do not sum to 1, that is said."""
    blocks: list[Block] = []
    for kpi, title in STATE_KPIS.items():
        if rows := material.rows(kpi):
            said = "; ".join(f"{row['subject']} {row['part']} {quantity(row['mean'], 'share')}" for row in rows)
            blocks += [_wrong(*of) for of in figures.wrong_sums(rows)]
            blocks.append(Chart(kpi, figures.states(rows), said, title, figures.legend(rows)))
    return Section("states", "What workers and stations were doing", blocks, "States") if blocks else None


def _wrong(subject: str, total: float) -> Caution:
    return Caution(
        f"The states of {subject} sum to {quantity(total, 'share')}, not to 100 %: do not trust this figure."
    )
