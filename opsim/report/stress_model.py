"""Items 1 to 3 of the STRESS-DES checklist: objectives, logic and data, from the summary and the scenario as run."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.names import enumerated
from opsim.report.material import Material
from opsim.report.movements import groups_of
from opsim.report.stress_item import BOTH, YOURS, Item, counted
from opsim.report.words import kpi_name

MOST_DIFFERENCES = 6
COMPONENTS = {
    "products": "entities: {}",
    "tasks": "activities: tasks {}",
    "stations": "resources: stations {}",
    "workers": "workers {}",
    "tools": "tools {}",
    "transporters": "vehicles {}",
    "conveyors": "conveyors {}",
    "stores": "queues: stores {}, and the buffers of stations",
}
Block = Mapping[str, Any]


def items_of(material: Material) -> list[Item]:
    """1.1 to 3.4."""
    summary, resolved = material.summary, material.loaded.resolved
    return [
        Item("1.1", "Purpose of the model", f"The model is called {summary['scenario']}; why it was made:", YOURS),
        Item("1.2", "Model outputs", _outputs(summary)),
        Item("1.3", "Experimentation aims", _aims(material), BOTH),
        Item("2.1", "Base model overview diagram", "The layout is drawn under On the floor where it has ways.", BOTH),
        Item("2.2", "Base model logic", _routes(resolved), BOTH),
        Item("2.3", "Scenario logic", _differences(material)),
        Item("2.4", "Algorithms", _rules(resolved)),
        Item("2.5", "Components", _components(resolved)),
        Item("3.1", "Data sources", _sources(material), BOTH),
        Item("3.2", "Pre-processing", "How recordings were cleaned and times were fitted:", YOURS),
        Item("3.3", "Input parameters", _parameters(material)),
        Item("3.4", "Assumptions", _assumed(summary), BOTH),
    ]


def _outputs(summary: Block) -> str:
    hours = "scheduled_h" in summary
    kinds = dict.fromkeys(row["kpi"] for row in summary["kpis"])
    front = dict.fromkeys(kpi_name(row["kpi"], hours) for row in summary["kpis"] if row.get("headline"))
    first = f", first of all {enumerated(list(front))}" if front else ""
    return f"{counted(len(kinds), 'figure')} of each replication{first}; all in the tables above and in kpis.parquet."


def _aims(material: Material) -> str:
    names = list(material.siblings)
    return f"Variants run: {enumerated(names)}. What they are to answer:" if len(names) > 1 else "One variant was run."


def _routes(resolved: Block) -> str:
    routes = [f"{name}: {_route(said.get('route'))}" for name, said in _of(resolved, "products").items()]
    shown = "; ".join(routes[:4]) + (f"; and {len(routes) - 4} more" if len(routes) > 4 else "")
    return f"Routes: {shown}. Every rule that holds is in the assumption sheet." if routes else ""


def _route(steps: Any) -> str:
    if not isinstance(steps, list):
        return str(steps)
    return " - ".join(" or ".join(map(str, step)) if isinstance(step, list) else _step(step) for step in steps)


def _step(step: Any) -> str:
    """A step's own name, where it is a block that says more."""
    if isinstance(step, dict):
        return next((str(step[key]) for key in ("station", "stations", "at", "to") if key in step), "a step")
    return str(step)


def _differences(material: Material) -> str:
    from opsim.study.folder import RESOLVED
    from opsim.study.resolved import differences, read_resolved

    base = next(iter(material.siblings.values()), None)
    if base is None or base.summary["variant"] == material.summary["variant"]:
        return "This is the variant that others are compared with." if len(material.siblings) > 1 else "One variant."
    text = (base.folder / RESOLVED).read_text(encoding="utf-8")
    found = differences(read_resolved(text), material.loaded.resolved)
    shown, more = found[:MOST_DIFFERENCES], len(found) - MOST_DIFFERENCES
    said = "; ".join(shown) + (f"; and {more} more" if more > 0 else "")
    return f"Against {base.summary['variant']}: {said or 'nothing that decides what happens'}."


def _rules(resolved: Block) -> str:
    flow, allocation = _of(resolved, "flow"), _of(resolved, "allocation")
    said = [
        f"waiting jobs by {flow.get('dispatch', 'fifo')}",
        f"alternative stations by {flow.get('routing', 'shortest_queue')}",
        *([f"free workers by {allocation['rule']}"] if "rule" in allocation else []),
        *([f"rotations {enumerated(list(_of(resolved, 'rotations')))}"] if _of(resolved, "rotations") else []),
    ]
    return f"Rules: {', '.join(said)}; each in words in the assumption sheet."


def _components(resolved: Block) -> str:
    named = [
        words.format(f"{enumerated(list(found))} ({len(found)})")
        for key, words in COMPONENTS.items()
        if (found := _of(resolved, key))
    ]
    sources = list(_of(resolved, "sources")) or (["release"] if resolved.get("release") else [])
    entry = [f"entry: {enumerated(sources)}; exit: the end of each route"] if sources else []
    return "; ".join([*named, *entry])


def _sources(material: Material) -> str:
    tasks = material.summary.get("tasks", [])
    learned = {str(of[0]["source"]) for of in groups_of(tasks).values()}
    files = list(material.manifest.get("recorded") or {})
    plain = [task["task"] for task in tasks if not task.get("emulated")]
    said = [
        *([f"movements: {'; '.join(sorted(learned))}"] if learned else []),
        *([f"files of times: {enumerated(files)}"] if files else []),
        *([f"the scenario itself for {enumerated(plain)}, whose source is yours to name"] if plain else []),
    ]
    text = ". ".join(said)
    return text[:1].upper() + text[1:] + "." if text else ""


def _parameters(material: Material) -> str:
    digest = material.manifest.get("resolved_sha256")
    mark = f" (sha256 {digest[:12]}...)" if digest else ""
    return f"Every value with its unit in scenario.resolved.yaml{mark}, beside this report; times of tasks above."


def _assumed(summary: Block) -> str:
    n = len(summary.get("assumptions") or [])
    return f"{counted(n, 'assumption')} in the assumption sheet; why they may be made:" if n else ""


def _of(block: Block, key: str) -> Block:
    found = block.get(key)
    return found if isinstance(found, dict) else {}
