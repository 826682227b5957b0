"""Movements to be scored that are drawn from a task of a library."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from opsim.cli.motion_score_source import Source, between, neutral_of


def drawn(model: Any, n: int, seed: int, asked: Any) -> Source:
    """So many performances, with that seed, as ``motion_score_asked.Asked`` asks."""
    import numpy as np

    from opsim.ergonomics.measures import measures_of, n_cells
    from opsim.ergonomics.neutral import neck_neutral_told_rad
    from opsim.ergonomics.shift.movement import Movement
    from opsim.one_thread import one_blas_thread
    from opsim.provenance import behind

    with one_blas_thread():
        block = model.sample(n, np.random.default_rng(seed))
        neutral, said = neutral_of(asked.neck_neutral_rad, neck_neutral_told_rad(model), "how draws of the task begin")
        measures, cells = measures_of(block, range(n), asked.options, neutral), n_cells(block, asked.options)
    carrying = _loaded_in(block, n, cells, asked.loaded, tuple(getattr(model, "mark_names", ())))
    movements = [
        Movement(
            f"draw {k + 1}",
            np.full(cells, block.duration_s[k] / cells),
            measures[k],
            _body(block, k, cells),
            carrying[k],
        )
        for k in range(n)
    ]
    report, names = model.report, tuple(model.skeleton.names)
    title = f"{model.task}: {n} drawn ({behind(report.source, report.n_sequences, report.n_workers)}), seed {seed}"
    walking, marks = bool(getattr(model, "walks", False)), tuple(getattr(model, "mark_names", ()))
    return Source(title, model.skeleton, movements, neutral, said, (), walking, marks, names)


def _loaded_in(block: Any, n: int, cells: int, loaded: Any, mark_names: tuple[str, ...]) -> list[Any]:
    """Of each draw, in which of its parts hands may be full; None where nobody said when."""
    import numpy as np

    from opsim.ergonomics.shift.seen import hands_full
    from opsim.plan.handling import Handling

    if loaded is None:
        return [None] * n
    start, end = loaded.moments(mark_names)
    shares = zip(*hands_full(Handling(start=start, end=end), block, np.arange(n)))
    return [between((np.arange(cells) + 0.5) / cells, moments) for moments in shares]


def _body(block: Any, row: int, cells: int) -> Callable[[int], Any]:
    """The joints in the middle of a part of a performance, decoded when they are asked for."""
    import numpy as np

    def joints_m(cell: int) -> Any:
        at_s = np.array([[(cell + 0.5) / cells * float(block.duration_s[row])]])
        return block[row].positions_m(times_s=at_s)[0, 0]

    return joints_m
