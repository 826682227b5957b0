"""What a report is made from, of a small scenario or of rows by hand, without any file."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

from plans import loaded

from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.kpi.table import samples
from opsim.plan import compile_plan
from opsim.report.material import Material
from opsim.study.replication import Replicated
from opsim.study.summary import summary_of
from tests.opsim.kpi.made_logs import made


@dataclass(frozen=True)
class MadeResult:
    """What sections need of a Result; it has rows where ``events_files`` names any."""

    summary: dict
    table: dict = field(default_factory=dict)
    events_files: tuple = ("replication_0",)

    def kpis(self):
        return self.table


def floor(text, *edits, rows=None, keeps_rows=True):
    """The Material of one replication of a scenario, some of its words replaced; rows : by hand instead of a run."""
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    read = loaded(text)
    plan = compile_plan(read)
    log = run_plan(plan) if rows is None else made(rows, plan)
    done = [Replicated(0, figures(log, plan), samples(log, plan))]
    result = MadeResult(summary_of(read, plan, done), events_files=("replication_0",) if keeps_rows else ())
    run = SimpleNamespace(result=result, manifest={}, loaded=read, plan=plan, log=lambda: log)
    return Material(run, {read.variant: result})


def renamed(material, **names):
    """The same with other names of stations, workers, products and tasks: such as no scenario could give."""
    plan = material.plan
    kinds = ("stations", "workers", "products", "tasks")
    new = {
        kind: tuple(replace(one, name=names.get(one.name, one.name)) for one in getattr(plan, kind)) for kind in kinds
    }
    summary = dict(material.summary)
    for table in ("kpis", "distributions"):
        rows = summary[table]
        summary[table] = [{**row, "subject": names.get(row["subject"], row["subject"])} for row in rows]
    result = replace(material.result, summary=summary)
    run = SimpleNamespace(**{**vars(material.run), "result": result, "plan": replace(plan, **new)})
    return Material(run, dict.fromkeys(material.siblings, result))


def beside(material, **siblings):
    """The same with other variants beside it."""
    return replace(material, siblings=siblings)


def charts(section):
    """By id, the figures of a section, those in panels too."""
    return {} if section is None else dict(section.charts)


def words(section):
    """All sentences of a section."""
    found = []
    for block in section.blocks:
        found += getattr(block, "items", []) or [getattr(block, "text", "")]
    return " ".join(found)


def bars(figure):
    """(row, start, end, trace's name) of every bar, in the axis' unit."""
    return [
        (row, base, base + length, trace["name"])
        for trace in figure["data"]
        if trace["type"] == "bar"
        for row, base, length in zip(trace["y"], trace["base"], trace["x"])
    ]


def strings(value):
    """Every text anywhere in a figure."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for one in value.values():
            yield from strings(one)
    elif isinstance(value, list | tuple):
        for one in value:
            yield from strings(one)
