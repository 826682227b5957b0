"""A result as one HTML file that needs nothing else: no network, no other file, no script but its own two."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from opsim.provenance import behind
from opsim.report import figures
from opsim.report.exposure import exposure_section
from opsim.report.kinds import KINDS, kind_of
from opsim.report.limit_sentences import limit_sentences
from opsim.report.offline import asset, policy, template
from opsim.report.parts import is_shown, part_name, without_again
from opsim.report.posture import SHARES, posture_section
from opsim.report.sentence import sentences
from opsim.report.words import clock, interval_cells, kpi_name, largest_mean, quantity
from opsim.whole import write_text

STATE_KPIS = {"worker_states": "Workers", "station_states": "Stations", "transporter_states": "Transporters"}
HISTOGRAMS = {
    "time_in_system_s": "Time in system, by product",
    "cycle_time_s": "Work a job gets, by station",
    "duration_s": "Duration of one performance, by task",
}
NO_MANIFEST: dict[str, Any] = {"python": "", "packages": {}, "libraries": {}, "recorded": {}, "resolved_sha256": ""}
MOST_HISTOGRAMS = 12
QUANTILES = (0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95)


def write_report(
    result: Any,
    path: str | Path,
    strips: Mapping[str, bytes] | None = None,
    walks: Mapping[str, Any] | None = None,
    days: Mapping[str, Any] | None = None,
    bodies: Mapping[str, Any] | None = None,
    curves: Sequence[Mapping[str, Any]] = (),
) -> Path:
    """Write the report of one scenario variant and return where it is.

    result : has ``summary`` (the content of summary.json) and ``folder`` (where manifest.json may lie)
    strips : SVG bytes by task name, e.g. of ``scenario_strips``; emulated tasks without one are named without a picture
    walks  : what ``walks_section`` says of walking, days: ``days_section`` of people, bodies: ``bodies_section`` of
        postures; None where nothing; curves : of ``curves_section``
    """
    path = Path(path)
    write_text(path, report_html(result.summary, _manifest(result), strips or {}, walks, days, bodies, curves))
    return path


def report_html(
    summary: Mapping[str, Any],
    manifest: Mapping[str, Any],
    strips: Mapping[str, bytes],
    walks: Mapping[str, Any] | None = None,
    days: Mapping[str, Any] | None = None,
    bodies: Mapping[str, Any] | None = None,
    curves: Sequence[Mapping[str, Any]] = (),
) -> str:
    """The page as text. Names are escaped: in HTML by jinja2, in JSON by ``tojson``, in figures by ``escape``."""
    bundle, script = asset("assets/plotly-cartesian.min.js"), asset("report.js")
    drawn: dict[str, Any] = {}
    shown = without_again([row for row in summary["kpis"] if is_shown(row["kpi"], row.get("part", ""), [row])])
    drawn |= {curve["id"]: curve["figure"] for curve in curves}
    hours = "scheduled_h" in summary
    context = {
        "summary": summary,
        "sentences": sentences(summary),
        "headline": _table([row for row in shown if _is_headline(row)], hours),
        "others": _groups([row for row in shown if not _is_headline(row)], hours),
        "states": _states(summary, drawn),
        "days": None if days is None else {**days, "picture": _as_source(days["picture"])},
        "posture": posture_section(summary["kpis"], drawn),
        "exposure": exposure_section(summary["kpis"], drawn),
        "curves": curves,
        "limits": limit_sentences(summary["kpis"]),
        "went": None if bodies is None else {**bodies, "picture": _as_source(bodies["picture"])},
        "histograms": _histograms(summary, drawn),
        "emulated": _emulated(summary.get("tasks", []), strips),
        "walking": None if walks is None else _walking(walks),
        "made_up": [task for task in summary.get("tasks", []) if not task.get("emulated")],
        "window": [clock(summary["start"], at_s) for at_s in summary["window_s"]],
        "manifest": {**NO_MANIFEST, **manifest},
        "figures": drawn,
        "bundle": bundle,
        "script": script,
        "style": asset("report.css"),
        "policy": policy(bundle, script),
        "quantity": quantity,
    }
    return template("report.html.jinja").render(context)


def _is_headline(row: Mapping[str, Any]) -> bool:
    return bool(row.get("headline")) and row["kpi"] not in (*STATE_KPIS, SHARES)


def _table(rows: Sequence[Mapping[str, Any]], hours: bool) -> list[dict[str, str]]:
    """Rows of cells; a figure's name is written at its first row only, and all its rows have one unit.

    hours : whether the floor keeps hours
    """
    kinds = list(dict.fromkeys(row["kpi"] for row in rows))
    return [cells for kind in kinds for cells in _rows_of(kind, [row for row in rows if row["kpi"] == kind], hours)]


def _rows_of(kpi: str, rows: Sequence[Mapping[str, Any]], hours: bool) -> list[dict[str, str]]:
    largest, name = largest_mean(rows), kpi_name(kpi, hours)
    named = [(row["subject"], part_name(kpi, row.get("part", ""))) for row in rows]
    subjects = [" · ".join(filter(None, of)) or "all" for of in named]
    cells = [interval_cells(row, largest) for row in rows]
    return [{"name": "" if i else name, "of": of, **cell} for i, (of, cell) in enumerate(zip(subjects, cells))]


def _groups(rows: Sequence[Mapping[str, Any]], hours: bool) -> list[dict[str, Any]]:
    """By what figures are of, tables to unfold: those of the whole together, the others each by itself."""
    by_kind = {kind: [row for row in rows if kind_of(row["kpi"]) == kind] for kind in KINDS}
    return [{"title": kind, "tables": _unfolded(of, hours)} for kind, of in by_kind.items() if of]


def _unfolded(rows: Sequence[Mapping[str, Any]], hours: bool) -> list[dict[str, Any]]:
    whole = [row for row in rows if not row["subject"]]
    kinds = list(dict.fromkeys(row["kpi"] for row in rows if row["subject"]))
    tables = [(kpi_name(kind, hours), [row for row in rows if row["kpi"] == kind and row["subject"]]) for kind in kinds]
    return [{"title": title, "rows": _table(of, hours)} for title, of in [("Of the whole", whole), *tables] if of]


def _states(summary: Mapping[str, Any], drawn: dict[str, Any]) -> list[dict[str, Any]]:
    shown = []
    for kpi, title in STATE_KPIS.items():
        rows = [row for row in summary["kpis"] if row["kpi"] == kpi]
        if rows:
            drawn[kpi] = figures.states(rows)
            words = "; ".join(f"{row['subject']} {row['part']} {quantity(row['mean'], 'share')}" for row in rows)
            wrong = [(subject, quantity(total, "share")) for subject, total in figures.wrong_sums(rows)]
            shown.append({"id": kpi, "title": title, "legend": figures.legend(rows), "words": words, "wrong": wrong})
    return shown


def _histograms(summary: Mapping[str, Any], drawn: dict[str, Any]) -> list[dict[str, Any]]:
    sections = []
    for kpi, title in HISTOGRAMS.items():
        found = [row for row in summary.get("distributions", []) if row["kpi"] == kpi and row.get("n")]
        panels = [_panel(row, f"{kpi}-{i}", i < MOST_HISTOGRAMS) for i, row in enumerate(found)]
        drawn |= {panel["id"]: panel["figure"] for panel in panels if panel["drawn"] and not panel["always"]}
        if panels:
            sections.append({"id": kpi, "title": title, "panels": panels, "more": max(0, len(found) - MOST_HISTOGRAMS)})
    return sections


def _panel(row: Mapping[str, Any], figure_id: str, is_drawn: bool) -> dict[str, Any]:
    """One histogram with its row of percentiles; times that are all the same need no picture."""
    quantiles = {float(q): value for q, value in row["quantiles"].items()}
    smallest, largest = min(quantiles.values()), max(quantiles.values())
    return {
        "id": figure_id,
        "drawn": is_drawn,
        "always": largest - smallest < 1e-5 * largest and not row.get("beyond"),
        "figure": figures.histogram(row),
        "name": row["subject"] or "all",
        "n": row["n"],
        "cells": [quantity(quantiles.get(q), "s") for q in QUANTILES],
        "beyond": row.get("beyond", 0),
    }


def _emulated(tasks: Sequence[Mapping[str, Any]], strips: Mapping[str, bytes]) -> list[dict[str, Any]]:
    """Emulated tasks, those of one model together with one strip."""
    groups: dict[tuple[str, str], dict[str, Any]] = {}
    for task in (task for task in tasks if task.get("emulated")):
        people = (task["source"], task["n_sequences"], task["n_workers"])
        key = (task.get("library", ""), task.get("library_task", task["model"]))
        group = groups.setdefault(key, {"source": task, "tasks": [], "strip": None, "behind": behind(*people)})
        group["tasks"].append(task)
        if group["strip"] is None and task["task"] in strips:
            group["strip"] = _as_source(strips[task["task"]])
    return list(groups.values())


def _walking(walks: Mapping[str, Any]) -> dict[str, Any]:
    """What the page says of walking, its pictures as sources of images."""
    source = walks["source"]
    shown = [{**walk, "picture": _as_source(walk["picture"])} for walk in walks["walks"]]
    return {**walks, "walks": shown, "behind": behind(source["source"], source["n_sequences"], source["n_workers"])}


def _as_source(svg: bytes) -> str:
    return "data:image/svg+xml;base64," + base64.b64encode(svg).decode()


def _manifest(result: Any) -> dict[str, Any]:
    path = Path(result.folder) / "manifest.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
