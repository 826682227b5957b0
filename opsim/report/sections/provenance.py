"""What a run takes as given, and what was checked of it.

Where everything in a report comes from: every task's times, libraries, versions, seeds, hashes.

An item of the STRESS-DES checklist.

Items 4 to 6 of the STRESS-DES checklist: experimentation, implementation and code access.

Items 1 to 3 of the STRESS-DES checklist: objectives, logic and data, from the summary and the scenario as run.

The STRESS-DES checklist for who reports a study, filled as far as the run knows.

Source: Monks, Currie, Onggo, Robinson, Kunc, Taylor (2019), Strengthening the reporting of empirical simulation
studies: introducing the STRESS guidelines. Journal of Simulation 13(1), 55-67. The 20 items of STRESS-DES.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from opsim.problems import enumerated
from opsim.report.material import Material
from opsim.report.numbers import clock, kpi_name, quantity
from opsim.report.page import Block, Bullets, Facts, Folded, Grid, Section, Words, asset
from opsim.report.sections.motions import groups_of
from opsim.task_model import behind

SAID = "What this run takes as given. Nothing here was measured by the run."


def assumptions_section(material: Material) -> Section:
    """The assumption sheet; a topic is written at its first row only."""
    summary = material.summary
    said = [(row["topic"], row["says"]) for row in summary.get("assumptions") or []]
    rows = [("" if i and said[i - 1][0] == topic else topic, says) for i, (topic, says) in enumerate(said)]
    blocks: list[Block] = [Words(SAID), Grid(("Topic", "What is assumed"), rows, "", words=2, said="assumption sheet")]
    if summary.get("checks"):
        blocks.append(Folded("Checked after every replication", [Bullets(summary["checks"])]))
    return Section("assumptions", "Assumption sheet", blocks, "Assumptions")


SEEDS = (
    "One seed for the whole study: every worker, task, station and source draws from random numbers of its own, by its "
    "name, so that variants meet the same luck."
)


def provenance_section(material: Material) -> Section:
    """Provenance; of every task what its times come from."""
    blocks: list[Block] = [Facts(_facts(material))]
    if rows := _tasks(material.summary):
        columns = ("Task", "Times from", "Learned from", "Licence", "Mean")
        blocks.append(Grid(columns, rows, "What stands behind every task", words=4, folded=True))
    blocks.append(Words(SEEDS, muted=True))
    return Section("provenance", "Provenance", blocks, "Provenance")


def plotly_version() -> str:
    """Of the bundle in every report, as the note beside it says."""
    found = re.search(r"plotly\.js (\d+\.\d+\.\d+)", asset("assets/plotly-cartesian.LICENSE.txt"))
    return found[1] if found else "of unknown version"


def _facts(material: Material) -> list[tuple[str, str, str]]:
    summary, manifest = material.summary, material.manifest
    packages = ", ".join(f"{name} {version}" for name, version in manifest.get("packages", {}).items())
    rows = [
        ("Scenario", f"{summary['scenario']}, variant {summary['variant']}, from {summary['file']}", ""),
        ("Seed, replications", f"{summary['seed']}, {summary['replications']}", ""),
        ("opsim", summary["opsim"], ""),
        ("Python", manifest.get("python", ""), ""),
        ("Packages", packages, ""),
        *((f"Library {name}", of["file"], f"sha256 {of['sha256']}") for name, of in _of(manifest, "libraries")),
        *(("Times from a file", name, f"sha256 {digest}") for name, digest in _of(manifest, "recorded")),
        *((f"Plug-in {name}", distribution, "") for name, distribution in _of(manifest, "plugins")),
        ("Resolved scenario", "", f"sha256 {manifest['resolved_sha256']}" if manifest.get("resolved_sha256") else ""),
        ("Figures drawn by", f"plotly.js {plotly_version()} (MIT licence, Plotly Inc.), inside this file", ""),
    ]
    return [row for row in rows if row[1] or row[2]]


def _of(manifest: Mapping[str, Any], key: str) -> list[tuple[str, Any]]:
    return list((manifest.get(key) or {}).items())


def _tasks(summary: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """A row a task, and one for walking where walking has postures."""
    rows = [_row(task["task"], task, quantity(task["mean_s"], "s")) for task in summary.get("tasks", [])]
    walking = summary.get("walking")
    return rows if walking is None else [*rows, _row("walking", {"emulated": True, **walking}, "")]


def _row(name: str, task: Mapping[str, Any], mean: str) -> tuple[str, ...]:
    if not task.get("emulated"):
        recorded = str(task["model"]).startswith("recorded")
        whose = "times from a file, no postures" if recorded else "nobody: the scenario says so"
        return (name, str(task["model"]), whose, "", mean)
    learned = behind(task["source"], task["n_sequences"], task["n_workers"])
    model = f"{task['model']}, {task['library']}"
    return (name, model, f"{learned}: {task['source']}", task["licence"], mean)


YOURS, RUN, BOTH = "to be written by you", "filled from the run", "begun by the run, yours to finish"


@dataclass(frozen=True)
class Item:
    """number : as in the guidelines; said : what the run knows, "" for nothing; by : YOURS, RUN or BOTH"""

    number: str
    title: str
    said: str
    by: str = RUN


def counted(n: int, one: str, many: str = "") -> str:
    """``1 worker``, ``3 workers``; "" for none."""
    return f"{n} {one if n == 1 else many or one + 's'}" if n else ""


STREAMS = (
    "Numpy's PCG64; every worker, task, station and source has streams of its own, found by its name and the "
    "replication, so that variants meet the same luck"
)
EXECUTION = (
    "Event by event, on SimPy's clock, in steps of 2^-20 s; of what happens at one instant, completions come first, "
    "then repairs, breakdowns, calendars and arrivals, each by name in natural order"
)


def items_of(material: Material) -> list[Item]:
    """4.1 to 6.1."""
    summary, manifest = material.summary, material.manifest
    return [
        Item("4.1", "Initialisation", _begun(summary), BOTH),
        Item("4.2", "Run length", _length(summary)),
        Item("4.3", "Estimation approach", _estimation(summary)),
        Item("5.1", "Software or programming language", _software(summary, manifest)),
        Item("5.2", "Random sampling", f"{STREAMS}. Seed {summary['seed']}."),
        Item("5.3", "Model execution", f"{EXECUTION}."),
        Item("5.4", "System specification", "The machine, and how long it took, are not kept:", YOURS),
        Item("6.1", "Computer model sharing statement", _shared(manifest), BOTH),
    ]


def _begun(summary: Mapping[str, Any]) -> str:
    warm_up_s = summary["window_s"][0]
    counted_from = "everything counts" if not warm_up_s else f"the first {quantity(warm_up_s, 's')} do not count"
    return (
        f"Begun {clock(summary['start'], 0)}, empty but for what the scenario puts into stores; {counted_from}. 'opsim "
        "warm-up' says what MSER-5 makes of it; why this warm-up:"
    )


def _length(summary: Mapping[str, Any]) -> str:
    low_s, high_s = summary["window_s"]
    hours = summary.get("scheduled_h")
    open_h = f", {hours:g} scheduled hours in it" if hours is not None else ""
    said = f"{clock(summary['start'], low_s)} to {clock(summary['start'], high_s)}"
    return f"{quantity(high_s, 's')} simulated; counted from {said}{open_h}."


def _estimation(summary: Mapping[str, Any]) -> str:
    n, sure = summary["replications"], 100 * summary["confidence"]
    asked = [f"{one['figure']} within {100 * one['wanted']:.2g} %" for one in summary.get("precision", [])]
    wanted = f", as many as it took for {enumerated(asked)}" if asked else ""
    return (
        f"{counted(n, 'replication')}{wanted}; means over them with {sure:.0f} % intervals by Student's t; variants "
        "are compared replication by replication, on the same random numbers."
    )


def _software(summary: Mapping[str, Any], manifest: Mapping[str, Any]) -> str:
    packages = [f"{name} {version}" for name, version in manifest.get("packages", {}).items()]
    python = f"Python {manifest['python']}" if manifest.get("python") else ""
    return ", ".join(filter(None, [f"opsim {summary['opsim']}", python, *packages])) + "."


def _shared(manifest: Mapping[str, Any]) -> str:
    files = [of["file"] for of in (manifest.get("libraries") or {}).values()]
    named = f", with {enumerated(files)}" if files else ""
    model = f"The model is scenario.resolved.yaml beside this report{named}"
    return f"opsim is free software (MIT). {model}; where you share it:"


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
Keys = Mapping[str, Any]


def model_items(material: Material) -> list[Item]:
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


def _outputs(summary: Keys) -> str:
    hours = "scheduled_h" in summary
    kinds = dict.fromkeys(row["kpi"] for row in summary["kpis"])
    front = dict.fromkeys(kpi_name(row["kpi"], hours) for row in summary["kpis"] if row.get("headline"))
    first = f", first of all {enumerated(list(front))}" if front else ""
    return f"{counted(len(kinds), 'figure')} of each replication{first}; all in the tables above and in kpis.parquet."


def _aims(material: Material) -> str:
    names = list(material.siblings)
    return f"Variants run: {enumerated(names)}. What they are to answer:" if len(names) > 1 else "One variant was run."


def _routes(resolved: Keys) -> str:
    routes = [f"{name}: {_route(said.get('route'))}" for name, said in _block_of(resolved, "products").items()]
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
    from opsim.study.resolved_scenario import differences, read_resolved
    from opsim.study.results_folder import RESOLVED

    base = next(iter(material.siblings.values()), None)
    if base is None or base.summary["variant"] == material.summary["variant"]:
        return "This is the variant that others are compared with." if len(material.siblings) > 1 else "One variant."
    text = (base.folder / RESOLVED).read_text(encoding="utf-8")
    found = differences(read_resolved(text), material.loaded.resolved)
    shown, more = found[:MOST_DIFFERENCES], len(found) - MOST_DIFFERENCES
    said = "; ".join(shown) + (f"; and {more} more" if more > 0 else "")
    return f"Against {base.summary['variant']}: {said or 'nothing that decides what happens'}."


def _rules(resolved: Keys) -> str:
    flow, allocation = _block_of(resolved, "flow"), _block_of(resolved, "allocation")
    said = [
        f"waiting jobs by {flow.get('dispatch', 'fifo')}",
        f"alternative stations by {flow.get('routing', 'shortest_queue')}",
        *([f"free workers by {allocation['rule']}"] if "rule" in allocation else []),
        *(
            [f"rotations {enumerated(list(_block_of(resolved, 'rotations')))}"]
            if _block_of(resolved, "rotations")
            else []
        ),
    ]
    return f"Rules: {', '.join(said)}; each in words in the assumption sheet."


def _components(resolved: Keys) -> str:
    named = [
        words.format(f"{enumerated(list(found))} ({len(found)})")
        for key, words in COMPONENTS.items()
        if (found := _block_of(resolved, key))
    ]
    sources = list(_block_of(resolved, "sources")) or (["release"] if resolved.get("release") else [])
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


def _assumed(summary: Keys) -> str:
    n = len(summary.get("assumptions") or [])
    return f"{counted(n, 'assumption')} in the assumption sheet; why they may be made:" if n else ""


def _block_of(block: Keys, key: str) -> Keys:
    found = block.get(key)
    return found if isinstance(found, dict) else {}


ABOUT_STRESS = (
    "The 20 items that a report of a discrete-event simulation should answer, after Monks et al. (2019), Strengthening "
    "the reporting of empirical simulation studies: introducing the STRESS guidelines. What a run knows of itself is "
    "filled in; what only you can know is left to you."
)
GROUPS = ("Objectives", "Logic", "Data", "Experimentation", "Implementation", "Code access")


def stress_des_section(material: Material) -> Section:
    """A row an item."""
    items = stress_items(material)
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
    return Section("stress-des", "STRESS-DES checklist", [Words(ABOUT_STRESS), Words(count), table], "Checklist")


def stress_items(material: Material) -> list[Item]:
    """All 20, in their order."""
    return [*model_items(material), *items_of(material)]
