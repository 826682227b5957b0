"""What a section is made from, put together by hand around a log and its plan."""

from dataclasses import replace
from types import SimpleNamespace

from opsim.kpi import figures


def of_log(log, plan, loaded, rows=(), variant="base", siblings=(), **more):
    """As ``opsim.report.material.Material``. rows : of the summary; without any those of this one replication"""
    kpis = list(rows) or [
        {
            "kpi": one.kpi, "subject": one.subject, "part": one.part, "unit": one.unit, "mean": one.value,
            "low": None, "high": None, "half_width": None, "n": 1, "headline": False,
        }
        for one in figures(log, plan)
    ]  # fmt: skip
    summary = {"kpis": kpis, "variant": variant, "confidence": 0.95, "start": "Mon 06:00", **more}
    return SimpleNamespace(
        log=log,
        plan=plan,
        loaded=loaded,
        summary=summary,
        siblings=dict(siblings),
        rows=lambda kpi: [row for row in kpis if row["kpi"] == kpi],
    )


def hostile(plan, name):
    """The plan with a name that would do harm for all stations, workers and tasks; no scenario may have one."""
    return replace(
        plan,
        stations=tuple(replace(one, name=f"{name}{one.name}") for one in plan.stations),
        workers=tuple(replace(one, name=f"{name}{one.name}") for one in plan.workers),
        tasks=tuple(replace(one, name=f"{name}{one.name}") for one in plan.tasks),
    )


def texts(section):
    """Everything that a section writes, as one text."""
    from opsim.report.page import flat

    found = []
    for block in flat(section.blocks):
        found += [str(getattr(block, name, "")) for name in ("text", "said", "title", "caption")]
        found += [" ".join(row) for row in getattr(block, "rows", ())]
    return "\n".join(found)
