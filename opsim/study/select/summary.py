"""What was found, as summary.json has it: numbers as they are, nothing that lives in memory only."""

from __future__ import annotations

from typing import Any


def summary_of(found: Any) -> dict[str, Any]:
    """What stands in summary.json, numbers as they are."""
    selection, fresh = found.selection, found.fresh
    return {
        "figure": dict(zip(("kpi", "subject", "part", "unit"), found.key)),
        "better": found.better,
        "procedure": found.procedure,
        "confidence": found.confidence,
        "indifference": found.indifference,
        "limits": [
            {"figure": one.name, "sense": one.sense, "bound": one.bound, "tolerance": one.tolerance, "unit": key[3]}
            for one, key in zip(found.limits, found.keys)
        ],
        "winner": found.winner or None,
        "ended": None if selection is None else selection.ended,
        "promise": "" if selection is None else selection.promise,
        "assumes": [] if selection is None else list(selection.assumes),
        "tied": [] if selection is None else list(selection.tied),
        "open_pairs": [] if selection is None else [list(pair) for pair in selection.open_pairs],
        "open_limits": [] if selection is None else [list(pair) for pair in selection.open_limits],
        "posterior": None if selection is None or selection.posterior is None else list(selection.posterior),
        "first_replication": found.first,
        "numbers_of_their_own": found.apart,
        "candidates": [] if selection is None else [_candidate(found, i) for i in range(len(selection.systems))],
        "stages": [] if selection is None else [{"n": one.n, "left": list(one.left)} for one in selection.stages],
        "fresh": None if fresh is None else _fresh_summary(found),
        "search": None if found.searched is None else _search_summary(found),
    }


def _candidate(found: Any, i: int) -> dict[str, Any]:
    selection, name = found.selection, found.selection.systems[i]
    out = next((one for one in selection.out if one.system == name), None)
    return {
        "name": name,
        "changes": dict(found.changes[name]),
        "mean": selection.means[i],
        "limits": list(selection.limited[i]),
        "n": selection.n[i],
        "asked": selection.asked[i],
        "needed": selection.needed[i] if selection.needed else None,
        "out_after": None if out is None else out.n,
        "out_by": None if out is None else out.by or None,
        "out_limit": None if out is None else out.limit or None,
    }


def _fresh_summary(found: Any) -> dict[str, Any]:
    fresh = found.fresh
    by = fresh.difference
    return {
        "first": fresh.first,
        "replications": fresh.n,
        "chosen": [_interval(one) for one in fresh.chosen],
        "base": None if by is None else {"name": found.base, "figures": [_interval(one) for one in fresh.base]},
        "difference": None if by is None else {**_interval(by), "p": fresh.p},
    }


def _interval(one: Any) -> dict[str, float]:
    return {"mean": one.mean, "half_width": one.half_width, "sd": one.sd, "n": one.n}


def _search_summary(found: Any) -> dict[str, Any]:
    tried = found.searched
    return {
        "replications": tried.replications,
        "finalists": dict(tried.finalists),
        "trials": [
            {
                "changes": dict(one.changes),
                "mean": one.mean,
                "over_in_tolerances": list(one.over),
                "refused": one.refused or None,
            }
            for one in tried.trials
        ],
    }
