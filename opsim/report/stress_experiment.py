"""Items 4 to 6 of the STRESS-DES checklist: experimentation, implementation and code access."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.names import enumerated
from opsim.report.material import Material
from opsim.report.stress_item import BOTH, YOURS, Item, counted
from opsim.report.words import clock, quantity

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
