"""Any performance of a run as BVH, drawn again as it was: the same body that took the same time."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from opsim.cli.export_asked import Asked
from opsim.cli.export_told import Told, size

FPS = 60.0


def export_bvh(asked: Asked) -> Told:
    """Write it. Raises ValueError where there is none such, or where it has no body."""
    from emulator.recordings.bvh_write import write_bvh
    from emulator.recordings.take import Take
    from opsim.study.reopened import reopened
    from opsim.week_clock import clock_words
    from opsim.whole import whole_file

    (result,) = asked.variants.values()
    run = reopened(result.folder)
    log = run.log(asked.replications[0])
    which = _which(asked, log, run.plan)
    fps = asked.options["fps"] or FPS
    positions_m, skeleton, what = (_walked if which.walk else _performed)(log, run.plan, which, fps)
    worker, start_s = asked.options["worker"], float(log["start_s"][which.rows[0]])
    take = Take(skeleton.names, skeleton.parents, positions_m, fps, worker=worker, trial=f"k{which.k}")
    with whole_file(asked.out) as temporary:
        write_bvh(take, temporary)
    begins = clock_words(start_s, run.plan.start_s)
    plain = {
        "out": str(asked.out),
        "worker": worker,
        "what": what,
        "k": which.k,
        "replication": log.replication,
        "start_s": start_s,
        "begins": begins,
        "frames": len(positions_m),
        "fps": fps,
    }
    words = f"{worker}, {what} {which.k}, from {begins} on: {len(positions_m)} frames at {fps:g} a second"
    return Told((f"{asked.out}: {words}, {size(asked.out.stat().st_size)}",), plain)


def _which(asked: Asked, log: Any, plan: Any) -> Any:
    from opsim.export.when import run_s
    from opsim.export.which import at_time, performance_of, walk_of

    how = asked.options
    if how["at"] is not None:
        return at_time(log, plan, how["worker"], run_s(how["at"], plan.start_s, log.horizon_s))
    if how["walk"]:
        return walk_of(log, plan, how["worker"], how["k"] or 0)
    return performance_of(log, plan, how["worker"], how["task"], how["k"] or 0)


def _performed(log: Any, plan: Any, which: Any, fps: float) -> tuple[Any, Any, str]:
    """(joints (T, J, 3), skeleton, what): all pieces as one, from where the worker began to where he left off."""
    from opsim.ergonomics.again import performance_again

    first = performance_again(log, plan, int(which.rows[0]))
    whole = replace(first, progress_to=float(log["progress_to"][which.rows[-1]]))
    if whole.skeleton is None:
        raise ValueError(f"task {whole.task} is a time without a body: there is no movement to write")
    begun_s = whole.progress_from * whole.duration_s
    times_s = begun_s + _frames_s(whole.progress_to * whole.duration_s - begun_s, fps)
    return whole.positions_m(times_s=times_s), whole.skeleton, whole.task


def _walked(log: Any, plan: Any, which: Any, fps: float) -> tuple[Any, Any, str]:
    """As ``_performed``: a walk straight on, in the time it took."""
    import numpy as np

    from opsim.ergonomics.walks import walk_again
    from opsim.walks import walks_of

    if plan.walking is None:
        raise ValueError("walking is time alone in this scenario: there is no movement to write")
    walks = walks_of(log, plan)
    at = int(np.flatnonzero((walks.worker == which.worker) & (walks.k == which.k))[0])
    drawn = walk_again(plan, log.replication, which.worker, which.k, float(walks.distance_m[at]))
    took_s, whole_s = float(walks.end_s[at] - walks.start_s[at]), float(walks.whole_s[at])
    times_s = _frames_s(min(took_s, whole_s), fps) * (drawn.duration_s / whole_s)
    return drawn.decoded("positions_m", times_s=times_s), drawn.block.skeleton, "walk"


def _frames_s(duration_s: float, fps: float) -> Any:
    import numpy as np

    return np.arange(max(2, round(duration_s * fps) + 1)) / fps
