"""The STRESS-DES checklist for who reports a study, filled as far as the run knows.

Source: Monks, Currie, Onggo, Robinson, Kunc, Taylor (2019), Strengthening the reporting of empirical simulation
studies: introducing the STRESS guidelines. Journal of Simulation 13(1), 55-67. The 20 items of STRESS-DES.
"""

from __future__ import annotations

from opsim.report import stress_experiment, stress_model
from opsim.report.material import Material
from opsim.report.section import Grid, Section, Words
from opsim.report.stress_item import YOURS, Item

SAID = (
    "The 20 items that a report of a discrete-event simulation should answer, after Monks et al. (2019), Strengthening "
    "the reporting of empirical simulation studies: introducing the STRESS guidelines. What a run knows of itself is "
    "filled in; what only you can know is left to you."
)
GROUPS = ("Objectives", "Logic", "Data", "Experimentation", "Implementation", "Code access")


def section(material: Material) -> Section:
    """A row an item."""
    items = items_of(material)
    rows, last = [], ""
    for item in items:
        group = GROUPS[int(item.number[0]) - 1]
        rows.append(("" if group == last else group, f"{item.number} {item.title}", item.said or "-", item.by))
        last = group
    left = sum(item.by == YOURS for item in items)
    table = Grid(
        ("Of", "Item", "What the run knows", "By whom"),
        rows,
        "The checklist",
        words=3,
        folded=True,
        left=(3,),
        tags=(3,),
    )
    count = f"{len(items) - left} of {len(items)} items are filled in as far as the run knows, {left} are yours alone."
    return Section("stress-des", "STRESS-DES checklist", [Words(SAID), Words(count), table], "Checklist")


def items_of(material: Material) -> list[Item]:
    """All 20, in their order."""
    return [*stress_model.items_of(material), *stress_experiment.items_of(material)]
