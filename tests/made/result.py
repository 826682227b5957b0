"""A made result: the shape of summary.json, with names that would do harm if they were not escaped."""

from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

SCRIPT = "<script>window.harmed = 1</script>"
IMAGE = '"><img src=x onerror="window.harmed = 1">'
BOLD = "<b>bold</b> & $x$ {{ 7 * 7 }}"
NAMES = (SCRIPT, IMAGE, BOLD)


@dataclass(frozen=True)
class MadeResult:
    """What a report needs of a Result."""

    summary: dict
    folder: Path = field(default=Path("nowhere"))
    events_files: tuple = ()


def kpi(name, subject="", part="", unit="s", mean=60.0, half_width=1.0, n=20, headline=False):
    known = half_width is not None and mean is not None
    return {
        "kpi": name,
        "subject": subject,
        "part": part,
        "unit": unit,
        "mean": mean,
        "low": mean - half_width if known else None,
        "high": mean + half_width if known else None,
        "half_width": half_width,
        "sd": 2.0,
        "n": n,
        "headline": headline,
    }


def distribution(name, subject):
    return {
        "kpi": name,
        "subject": subject,
        "n": 100,
        "beyond": 3,
        "quantiles": {"0.05": 1.0, "0.1": 2.0, "0.25": 3.0, "0.5": 5.0, "0.75": 6.0, "0.9": 8.0, "0.95": 9.0},
        "histogram": {"edges": [0.0, 2.5, 5.0, 10.0], "counts": [20, 50, 27]},
    }


def states(kind, subject, **shares):
    return [kpi(kind, subject, part, "share", share, 0.01) for part, share in shares.items()]


def summary(worker="ana", station="weld", task="lift", product="pump", scenario="Made line", **other):
    """A summary as summary.json has it."""
    emulated = {
        "task": task,
        "station": station,
        "model": "emulator moves/squat",
        "emulated": True,
        "library": "libraries/moves.npz",
        "library_task": "squat",
        "source": "Made recordings 2026",
        "licence": "public domain",
        "n_sequences": 41,
        "n_workers": 6,
        "mean_s": 2.6,
    }
    fixed = {"task": f"{task}2", "station": station, "model": "fixed, 25 s", "emulated": False, "mean_s": 25.0}
    return {
        "opsim": "0.1.0",
        "scenario": scenario,
        "variant": "base",
        "file": "made.yaml",
        "seed": 7,
        "replications": 20,
        "confidence": 0.95,
        "start": "Mon 06:00",
        "window_s": [1800, 28800],
        "kpis": [
            kpi("throughput_per_h", unit="1/h", mean=60.1, half_width=1.04, headline=True),
            kpi("time_in_system_s", mean=1384.0, half_width=60.0, headline=True),
            kpi("time_in_system_s", product, mean=600.0, half_width=6.0, headline=True),
            kpi("work_in_progress", unit="jobs", mean=7.1, half_width=0.2),
            *states("worker_states", worker, work=0.82, walk=0.08, wait=0.1),
            *states("station_states", station, work=0.5, blocked=0.2, waiting=0.05, starved=0.25),
            kpi("walked_m", worker, unit="m", mean=5400.0, half_width=40.0),
        ],
        "distributions": [
            distribution("time_in_system_s", product),
            distribution("cycle_time_s", station),
            distribution("duration_s", task),
        ],
        "tasks": [emulated, fixed],
        "assumptions": [{"topic": "walking", "says": f"{worker} walks at 1.2 m/s"}],
        "checks": ["every job is accounted for"],
        **other,
    }


def hostile():
    """The same with hostile names everywhere a scenario may name something."""
    return summary(worker=SCRIPT, station=IMAGE, task=BOLD, product=SCRIPT, scenario=f"{SCRIPT}{IMAGE}{BOLD}")


def empty_plan():
    """A plan of a floor where nothing is."""
    from opsim.plan import Plan

    return Plan("made", 7, 28800.0, 1800.0, *[()] * 7, "nearest", "leave", "home", "fixed", "as_recorded")


@dataclass(frozen=True)
class MadeRun:
    """What a Material needs of a reopened run; no rows are kept of it, and its plan is empty."""

    result: MadeResult
    manifest: dict
    loaded: object = field(default_factory=lambda: SimpleNamespace(resolved={}))
    plan: object = field(default_factory=lambda: empty_plan())


def material(content, folder=Path("nowhere"), manifest=None, strip=b"<svg/>", siblings=()):
    """A Material of a made summary: its movements are drawn already."""
    from opsim.report.material import Material
    from opsim.report.sections.motions import groups_of

    result = MadeResult(content, folder)
    pictures = dict.fromkeys(groups_of(content["tasks"]), strip)
    beside = {content["variant"]: result, **dict(siblings)}
    return Material(MadeRun(result, manifest or {}), beside, pictures)


def page(content, **other):
    """The report of a made summary, as text."""
    from opsim.report.render import report_html

    return report_html(material(content, **other))
