"""A sweep as plain values, for summary.json."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from opsim.scenario.changes import flow_text
from opsim.study.interval import Interval
from opsim.study.sweep.factors import UNCHANGED, Factor
from opsim.study.sweep.found import Found
from opsim.study.sweep.points import Points


def summary_of(points: Points, found: Sequence[Found], replications: int) -> dict[str, Any]:
    """For machines: the points, and of every figure what ``Found`` says."""
    return {
        "design": points.design,
        "replications": replications,
        "factors": [_factor(factor) for factor in points.factors],
        "points": [
            {f.path: value for f, value in zip(points.factors, values) if value is not UNCHANGED}
            for values in points.values
        ],
        "figures": [_figure(one) for one in found],
        "words": [*points.words, *points.warned],
    }


def _factor(factor: Factor) -> dict[str, Any]:
    values = [value for value in factor.values if value is not UNCHANGED]
    return {"path": factor.path, **({"from": values[0], "to": values[1]} if factor.is_range else {"values": values})}


def _figure(found: Found) -> dict[str, Any]:
    said: dict[str, Any] = dict(zip(("kpi", "subject", "part", "unit"), found.key))
    said["points"] = [_interval(one) for one in found.means]
    if found.swings:
        said["against"] = found.how
        said["factors"] = [
            {
                "path": one.name,
                "lowest_at": one.levels[one.least].name,
                "highest_at": one.levels[one.most].name,
                "difference": _interval(one.rise),
                "clear": one.clear,
                "levels": [
                    {"value": level.name, "mean": _interval(level.mean), "change": _interval(level.change)}
                    for level in one.levels
                ],
            }
            for one in found.swings
        ]
    if found.sensitivity:
        said["sensitivity"] = [
            {"path": f.path, **{k: getattr(one, k) for k in ("alone", "alone_half", "total", "total_half", "spread")}}
            for f, one in zip(found.factors, found.sensitivity)
        ]
        said["noise_share"] = found.noise_share
    if found.response is not None:
        said["response"] = _response(found)
    if found.best is not None:
        said["best"] = {
            "point": found.best.row + 1,
            "better": found.best.better,
            "not_told_from_it": found.best.like_it,
        }
    return said


def _response(found: Found) -> dict[str, Any]:
    response = found.response
    assert response is not None
    return {
        "kind": response.kind,
        "centre": response.room.centre.tolist(),
        "half_range": response.room.half.tolist(),
        "terms": [
            {
                "of": [_part(found.factors, part) for part in term],
                "coefficient": float(value),
                "half_width": float(half),
            }
            for term, value, half in zip(response.terms, response.coefficients, response.half_widths)
        ],
        **{k: getattr(response, k) for k in ("loo_rmse", "noise", "r2", "r2_predicted", "lack_of_fit_p", "trusted")},
    }


def _part(factors: Sequence[Factor], part: tuple[int, int]) -> dict[str, Any]:
    factor, what = factors[part[0]], part[1]
    return {"path": factor.path, **({"power": what} if what > 0 else {"is": flow_text(factor.values[-what])})}


def _interval(one: Interval) -> dict[str, Any]:
    return {"mean": one.mean, "low": one.low, "high": one.high, "sd": one.sd, "n": one.n}
