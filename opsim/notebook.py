"""What a notebook shows of the main objects: small, escaped HTML without scripts.

Pieces of HTML for notebooks: every text escaped, no script, no style but what stands at an element.

A comparison in a notebook, and as a table: what differs from the base, and how sure that is.

Small SVGs for notebooks: bars of shares, and a body at some moments of a movement, seen from the side.

An EventLog in a notebook: how many rows of which kind, and what the workers did.

A performance in a notebook: whose, of what, how long, and the body that did it.

Results in a notebook: what was run, and its figures with their intervals.

A scenario in a notebook: who works where on what.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from opsim.log import KINDS, WORKER_KINDS, EventLog
from opsim.performance import Performance
from opsim.report.plot.plotly import OTHER, STATE_COLOURS
from opsim.results import Result

MOST_ROWS = 20


def sentence(*words: str) -> str:
    """A paragraph."""
    return f"<p>{escape(' '.join(word for word in words if word))}</p>"


def table(columns: Sequence[str], rows: Iterable[Sequence[object]], most: int = MOST_ROWS) -> str:
    """A table; of more than ``most`` rows the first, and how many follow. Numbers stand to the right."""
    listed = list(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join(f"<tr>{''.join(map(_cell, row))}</tr>" for row in listed[:most])
    more = sentence(f"and {len(listed) - most} more") if len(listed) > most else ""
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}"


def _cell(value: object) -> str:
    if isinstance(value, str):
        return f'<td style="text-align:left">{escape(value)}</td>'
    return f'<td style="text-align:right">{escape(number(value))}</td>'


def number(value: object) -> str:
    """A number as a table has it; nothing where there is none."""
    if value is None or (isinstance(value, float) and value != value):
        return ""
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 10_000 else f"{value:,.0f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def count(n: int, word: str, words: str = "") -> str:
    """``1 worker``, ``2 workers``."""
    return f"{n:,} {word if n == 1 else words or word + 's'}"


def duration(seconds: float) -> str:
    """A time in the unit that people would say it in."""
    for unit_s, unit in ((86_400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if seconds >= 2 * unit_s:
            return f"{seconds / unit_s:.4g} {unit}"
    return f"{seconds:.3g} s"


COLUMNS = ("variant", "kpi", "subject", "part", "unit", "base", "mean", "difference", "low", "high", "p", "verdict")


def comparison_rows(comparison: Any) -> list[tuple[object, ...]]:
    """A row for each figure of each variant, in the order of ``COLUMNS``."""
    return [
        (
            *(one.variant, *one.key, one.base, one.mean, one.interval.mean, one.interval.low, one.interval.high),
            *(one.p_together, one.verdict),
        )
        for one in comparison.differences
    ]


def comparison_html(comparison: Any) -> str:
    """What is clear stands first."""
    rows = comparison_rows(comparison)
    rows.sort(key=lambda row: row[-1] not in ("higher", "lower"))
    return sentence("Comparison:", f"differences from {comparison.base}, {comparison.pairs}.") + table(COLUMNS, rows)


WIDE, BAR = 480, 16
NAME = 110
FIGURES = 6
TALL = 150


def share_bars(bars: Mapping[str, Mapping[str, float]], colours: Mapping[str, str]) -> str:
    """A bar of parts for each name, as long as their shares; the parts' names stand below and at each part."""
    used = [part for part in colours if any(shares.get(part, 0) > 0 for shares in bars.values())]
    lines = []
    for row, (name, shares) in enumerate(bars.items()):
        y, x = row * (BAR + 4), float(NAME)
        lines.append(_text(NAME - 6, y + BAR - 4, _short(name), anchor="end"))
        for part in used:
            wide = shares.get(part, 0.0) * (WIDE - NAME)
            said = f"<title>{escape(f'{name}: {part} {shares.get(part, 0.0):.1%}')}</title>"
            lines.append(
                f'<rect x="{x:.1f}" y="{y}" width="{wide:.1f}" height="{BAR}" fill="{colours[part]}">{said}</rect>'
            )
            x += wide
    legend, below = [], len(bars) * (BAR + 4) + 4
    for at, part in enumerate(used):
        x = NAME + at % 4 * 90
        y = below + at // 4 * 16
        legend.append(f'<rect x="{x}" y="{y}" width="10" height="10" fill="{colours[part]}"/>')
        legend.append(_text(x + 14, y + 9, part))
    tall = below + -(-len(used) // 4) * 16
    return _svg(WIDE, tall, "".join([*lines, *legend]), "shares of time")


def bodies(positions_m: np.ndarray, parents: Sequence[int], said: str) -> str:
    """Lines along the bones at some even moments, left to right. positions_m : (T, J, 3), z up"""
    moments = np.linspace(0, len(positions_m) - 1, min(FIGURES, len(positions_m))).round().astype(int)
    some = positions_m[moments] - positions_m[moments][:, :1] * [1, 1, 0]
    side = some[:, :, _widest(some)]
    scale = (TALL - 20) / max(float(np.ptp(some[:, :, 2])), 1e-6)
    step = WIDE / len(moments)
    lines = []
    for at, (across, up) in enumerate(zip(side, some[:, :, 2] - some[:, :, 2].min())):
        xs, ys = step * (at + 0.5) + scale * across, TALL - 10 - scale * up
        bones = "".join(
            f"M{xs[parent]:.1f} {ys[parent]:.1f}L{xs[joint]:.1f} {ys[joint]:.1f}"
            for joint, parent in enumerate(parents)
            if parent >= 0
        )
        lines.append(f'<path d="{bones}" fill="none" stroke="#0072B2" stroke-width="2.5" stroke-linecap="round"/>')
    floor = f'<path d="M0 {TALL - 10}H{WIDE}" stroke="#999"/>'
    return _svg(WIDE, TALL, floor + "".join(lines), said)


def _widest(positions_m: np.ndarray) -> int:
    """The level axis along which the body reaches farther: it is seen across that one."""
    return int(np.argmax(np.ptp(positions_m[:, :, :2], axis=(0, 1))))


def _text(x: float, y: float, words: str, anchor: str = "start") -> str:
    return f'<text x="{x:g}" y="{y:g}" font-size="11" fill="#555" text-anchor="{anchor}">{escape(words)}</text>'


def _short(name: str) -> str:
    return name if len(name) <= 16 else f"{name[:15]}…"


def _svg(wide: int, tall: int, inside: str, said: str) -> str:
    size = f'viewBox="0 0 {wide} {tall}" width="{wide}" style="max-width:100%"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{escape(said)}">{inside}</svg>'


def log_html(log: EventLog) -> str:
    """A sentence, the workers' states as bars, and a table by kind."""
    words = f"{count(len(log), 'row')} of replication {log.replication}, {duration(log.horizon_s)}."
    rows = [
        (KINDS[kind], int(np.sum(log["kind"] == kind)), float(log.duration_s[log["kind"] == kind].sum()) / 3600)
        for kind in np.unique(log["kind"]).tolist()
    ]
    return sentence("EventLog:", words) + _workers(log) + table(("kind", "rows", "hours"), rows)


def _workers(log: EventLog) -> str:
    bars: dict[str, dict[str, float]] = {}
    for rank in np.unique(log["worker"]).tolist()[: MOST_ROWS + 1]:
        if rank < 0 or not log.horizon_s:
            continue
        own = log.where((log["worker"] == rank) & np.isin(log["kind"], WORKER_KINDS))
        spent_s = np.bincount(own["kind"], weights=own.duration_s, minlength=len(KINDS))
        bars[log.names["worker"][rank]] = {KINDS[kind]: float(spent_s[kind]) / log.horizon_s for kind in WORKER_KINDS}
    colours = {KINDS[kind]: STATE_COLOURS.get(KINDS[kind], OTHER)[0] for kind in WORKER_KINDS}
    return share_bars(bars, colours) if bars else ""


def performance_html(one: Performance) -> str:
    """A sentence, and the body at some moments where there is one."""
    part = "" if (one.progress_from, one.progress_to) == (0.0, 1.0) else _part(one)
    words = (
        f"{one.worker}, {one.task}, performance {one.k}{part}: "
        f"{one.end_s - one.start_s:.2f} s from {one.start_s:.2f} s on."
    )
    skeleton = one.skeleton
    if skeleton is None or one.progress_to <= one.progress_from:
        return sentence("Performance:", words)
    return sentence("Performance:", words) + bodies(
        one.positions_m(n_times=6), skeleton.parents, f"{one.task}, the body"
    )


def _part(one: Performance) -> str:
    return f" ({one.progress_from:.0%} to {one.progress_to:.0%} of it)"


def result_html(result: Result) -> str:
    """A sentence and the headline figures; of other results all."""
    said = result.summary
    rows = said["kpis"]
    front = [row for row in rows if row.get("headline")] or rows
    words = (
        f"{said.get('scenario', result.folder.name)}, variant {said.get('variant', '')}: "
        f"{count(said['replications'], 'replication')}, seed {said['seed']}."
    )
    columns = ("figure", "of", "part", "mean", "±", "unit")
    return sentence("Result:", words) + table(columns, [_row(row) for row in front])


def _row(row: dict[str, Any]) -> tuple[object, ...]:
    return row["kpi"], row["subject"], row["part"], row["mean"], row["half_width"], row["unit"]


def scenario_html(scenario: Any, variant: str = "") -> str:
    """A sentence, the stations with their tasks, and the products with their routes."""
    run = scenario.run
    of = f", variant {variant}" if variant else ""
    words = (
        f"{scenario.name}{of}: {_counts(scenario.stations, scenario.workers, scenario.products)}; "
        f"{duration(run.horizon_s)} from {run.start} on, {count(run.replications, 'replication')}."
    )
    stations = [(name, one.at, one.servers, ", ".join(one.tasks)) for name, one in scenario.stations.items()]
    return sentence("Scenario:", words) + table(("station", "at", "servers", "tasks"), stations)


def plan_html(plan: Any) -> str:
    """The same of a Plan: names for the numbers."""
    words = (
        f"{plan.name}: {_counts(plan.stations, plan.workers, plan.products)}; "
        f"{duration(plan.horizon_s)}, seed {plan.seed}."
    )
    stations = [
        (
            one.name,
            one.kind,
            plan.places[one.place],
            one.servers,
            ", ".join(plan.tasks[task].name for task in one.tasks),
        )
        for one in plan.stations
    ]
    return sentence("Plan:", words) + table(("point of the flow", "kind", "at", "servers", "tasks"), stations)


def _counts(stations: Any, workers: Any, products: Any) -> str:
    return f"{count(len(stations), 'station')}, {count(len(workers), 'worker')}, {count(len(products), 'product')}"
