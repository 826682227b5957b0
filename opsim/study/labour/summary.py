"""What a labour study found, as JSON: numbers as they are, in SI, none of them rounded."""

from __future__ import annotations

from typing import Any

from opsim.results import Key
from opsim.study.interval import Interval
from opsim.study.labour.budget import FigureBudget
from opsim.study.labour.buy_back import BoughtBack
from opsim.study.labour.day_asked import DayFound
from opsim.study.labour.parts import VariancePart, VarianceParts
from opsim.study.labour.study import LabourFound

KEY = ("kpi", "subject", "part", "unit")


def labour_summary(found: LabourFound) -> dict[str, Any]:
    """The content of summary.json."""
    return {
        "design": found.design,
        "workforces": found.workforces,
        "replications": found.replications,
        "variance": [_parts(key, parts) for key, parts in found.parts.items()],
        "sources": [{"name": s.name, "off": s.off, "keeps_mean": s.keeps_mean} for s in found.sources],
        "budget": [_budget(one) for one in found.budget],
        "bought_back": None if found.bought is None else _bought(found.bought),
        "day": _day(found.day),
        "warning": found.warning or None,
        "notes": list(found.words),
    }


def _parts(key: Key, parts: VarianceParts) -> dict[str, Any]:
    every = parts.parts if parts.run in parts.parts else (*parts.parts, parts.run)
    return {**dict(zip(KEY, key)), "mean": parts.mean, "parts": {part.name: _part(part, parts) for part in every}}


def _part(part: VariancePart, parts: VarianceParts) -> dict[str, Any]:
    return {
        "sd": part.sd,
        "low_sd": part.low_sd,
        "high_sd": part.high_sd,
        "estimate_of_variance": part.estimate,
        "truncated": part.truncated,
        "share": parts.share(part.name),
    }


def _budget(one: FigureBudget) -> dict[str, Any]:
    return {
        **dict(zip(KEY, one.key)),
        "as_it_is": _interval(one.full),
        "all_off": _interval(one.all_off),
        "parts": {name: _interval(of) for name, of in one.parts.items()},
        "interaction": _interval(one.interaction),
        "whole": _interval(one.whole),
        "alone": {name: _interval(of) for name, of in one.alone.items()},
    }


def _bought(bought: BoughtBack) -> dict[str, Any]:
    return {
        "loss": _interval(bought.loss),
        "without_the_loss": _interval(bought.equal),
        "ways": [
            {
                "name": curve.name,
                "kind": curve.kind,
                "first_enough": None if curve.first is None else curve.first.count,
                "steps": [
                    {
                        "more": s.count,
                        "gained": _interval(s.gained),
                        "beyond": _interval(s.beyond),
                        "enough": s.enough,
                        "sure": s.surely,
                    }
                    for s in curve.steps
                ],
            }
            for curve in bought.curves
        ],
    }


def _day(day: DayFound) -> dict[str, Any]:
    met = day.chance
    return {
        "figure": "good units of a day" if day.asked.a_day else day.asked.name,
        "hours": day.asked.hours if day.asked.a_day else None,
        "quantiles": [{"q": q.q, "estimate": q.estimate, "low": q.low, "high": q.high} for q in day.quantiles],
        "target": None if day.asked.target is None else day.asked.target.words,
        "chance": None
        if met is None
        else {
            "estimate": met.estimate,
            "low": met.low,
            "high": met.high,
            "count": met.count,
            "n": met.n,
            "counts_as": met.counts_as,
        },
    }


def _interval(of: Interval) -> dict[str, float]:
    return {"mean": of.mean, "half_width": of.half_width, "low": of.low, "high": of.high}
