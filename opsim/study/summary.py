"""Replications -> the table of intervals, histograms, tasks and assumptions that report and tables show."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from opsim import __version__
from opsim.kpi.catalogue import headline, needs_postures
from opsim.kpi.window import open_hours
from opsim.laws.audit import checks_of
from opsim.log_parquet import name_list, parquet_file
from opsim.plan import Plan
from opsim.results import Key
from opsim.study.assumptions import (
    NOTHING_ASKED,
    Asked,
    Assumption,
    assumptions_of,
    posture_assumptions,
    task_sources,
    warnings_of,
)
from opsim.study.intervals import CONFIDENCE, Reached, t_interval
from opsim.study.replication import Replicated
from opsim.subjects.human.assumptions import walking_source
from opsim.subjects.shifts.hours import floor_has_hours

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded


QUANTILES = (0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95)
MOST_BINS = 40
KEY = ("kpi", "subject", "part", "unit")


def summary_of(
    loaded: Loaded,
    plan: Plan,
    done: Sequence[Replicated],
    asked: Asked = NOTHING_ASKED,
    reached: Sequence[Reached] = (),
) -> dict:
    """The content of ``summary.json``; ``scheduled_h`` (hours of the window) only where the floor keeps hours.

    asked : what this run had instead of the file's own; reached : what became of the precision that was wanted
    """
    return {
        "opsim": __version__,
        "scenario": plan.name,
        "variant": loaded.variant,
        "file": loaded.file.name,
        "seed": plan.seed,
        "replications": len(done),
        "confidence": CONFIDENCE,
        "precision": [
            {"figure": one.precision.name, "wanted": one.precision.relative, "found": one.found, "reached": one.reached}
            for one in reached
        ],
        "start": loaded.scenario.run.start,
        "window_s": list(plan.window_s),
        **({"scheduled_h": open_hours(plan)} if floor_has_hours(plan) else {}),
        "kpis": _intervals(done, headline(loaded.scenario.outputs)),
        "distributions": _distributions(done),
        "tasks": task_sources(loaded, plan),
        **({} if plan.walking is None else {"walking": walking_source(loaded, plan)}),
        "assumptions": [{"topic": topic, "says": says} for topic, says in _assumptions(loaded, plan, done, asked)],
        "checks": list(checks_of(plan)),
        "warnings": warnings_of(done, plan),
        **({"frontier": list(loaded.scenario.frontier)} if loaded.scenario.frontier else {}),
    }


def _assumptions(loaded: Loaded, plan: Plan, done: Sequence[Replicated], asked: Asked) -> list[Assumption]:
    measured = done and needs_postures(figure.kpi for figure in done[0].figures)
    return [*assumptions_of(loaded, plan, asked), *(posture_assumptions(plan) if measured else ())]


def write_kpis(done: Sequence[Replicated], path: Path) -> None:
    """Every figure of every replication as Parquet: replication, kpi, subject, part, unit, value."""
    keys: dict[Key, int] = {}
    codes, values = array("q"), array("d")
    for result in done:
        for kpi, subject, part, unit, value in result.figures:
            codes.append(keys.setdefault((kpi, subject, part, unit), len(keys)))
            values.append(value)
    rows = {
        "replication": np.repeat([one.replication for one in done], [len(one.figures) for one in done]),
        "code": np.frombuffer(codes, np.int64),
        "value": np.frombuffer(values),
    }
    named = [f"list_extract({name_list(of)}, code + 1) AS {name}" for name, of in zip(KEY, zip(*keys))]
    with parquet_file(path) as (connection, temporary):
        connection.register("kpi_rows", rows)
        connection.execute(
            f"COPY (SELECT replication, {', '.join(named)}, "
            "CASE WHEN isnan(value) THEN NULL ELSE value END AS value "
            f"FROM kpi_rows) TO {temporary} (FORMAT parquet, COMPRESSION zstd)"
        )


def _intervals(done: Sequence[Replicated], in_front: set[str]) -> list[dict]:
    values: dict[Key, array[float]] = {}
    for result in done:
        for kpi, subject, part, unit, value in result.figures:
            values.setdefault((kpi, subject, part, unit), array("d")).append(value)
    return [_row(key, found, key[0] in in_front) for key, found in values.items()]


def _row(key: Key, values: Sequence[float], headline: bool) -> dict:
    interval = t_interval(values)
    return {
        **dict(zip(KEY, key)),
        "mean": interval.mean,
        "low": interval.low,
        "high": interval.high,
        "half_width": interval.half_width,
        "sd": interval.sd,
        "n": interval.n,
        "headline": headline,
    }


def _distributions(done: Sequence[Replicated]) -> list[dict]:
    keys = list(dict.fromkeys(key for result in done for key in result.samples))
    pooled = {key: np.concatenate([result.samples[key] for result in done if key in result.samples]) for key in keys}
    return [_distribution(*key, values) for key, values in pooled.items() if values.size]


def _distribution(kpi: str, subject: str, values: np.ndarray) -> dict:
    bins = int(np.clip(np.sqrt(values.size), 5, MOST_BINS))
    low, high = float(values.min()), float(np.quantile(values, 0.995))
    high = max(high, low + max(1e-6, abs(low) * 1e-9))  # bins must be wider than the spacing of floats there
    counts, edges = np.histogram(values, bins=bins, range=(low, high))
    return {
        "kpi": kpi,
        "subject": subject,
        "n": int(values.size),
        "beyond": int((values > edges[-1]).sum()),
        "quantiles": {str(q): float(np.quantile(values, q)) for q in QUANTILES},
        "histogram": {"edges": edges.tolist(), "counts": counts.tolist()},
    }
