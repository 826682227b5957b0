"""A long run for machines."""

from __future__ import annotations

from typing import Any

from opsim.study.long_run.looked import LongRun, LongSeries


def as_json(run: LongRun) -> dict[str, Any]:
    """Plain values, in a fixed order."""
    return {
        "study": "long_run",
        "scenario": run.scenario,
        "variant": run.variant,
        "seed": run.seed,
        "replications": run.replications,
        "horizon_s": run.horizon_s,
        "own_warm_up_s": run.own_warm_up_s,
        "left_out_s": run.left_out_s,
        "left_out": run.why,
        "believable": not run.serious,
        "parts_of_days": run.part_of_days,
        "never_without_a_job": list(run.full_stations),
        "nobody_ever_free": run.nobody_free,
        "series": [_series(one) for one in run.series],
    }


def _series(one: LongSeries) -> dict[str, Any]:
    found = one.batches
    numbers = ("mean", "half_width", "low", "high", "half_width_overlapping", "confidence", "lag_one", "independent")
    return {
        "kpi": one.name,
        "unit": one.unit,
        "warm_up_mser_s": one.warm_up_s,
        **({} if found is None else {name: getattr(found, name) for name in numbers}),
        "batches": 0 if found is None else found.n,
        "batch_s": one.batch_s,
        "batch_jobs": one.batch_jobs,
        "batch_means": [] if found is None else found.means.tolist(),
        "flags": [{"code": flag.code, "serious": flag.serious, "by": flag.by, "says": flag.says} for flag in one.flags],
    }
