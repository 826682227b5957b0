"""Where everything in a report comes from: every task's times, libraries, versions, seeds, hashes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from opsim.provenance import behind
from opsim.report.material import Material
from opsim.report.offline import asset
from opsim.report.section import Block, Facts, Grid, Section, Words
from opsim.report.words import quantity

SEEDS = (
    "One seed for the whole study: every worker, task, station and source draws from random numbers of its own, by its "
    "name, so that variants meet the same luck."
)


def section(material: Material) -> Section:
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
