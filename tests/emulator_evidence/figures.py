"""Numbers that the emulator of a checkout gives: fits of made tasks, draws, decoded bodies, library bytes, tables.

``python figures.py OUT.npz``, with the checkout in PYTHONPATH; imports nothing but ``emulator``.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from emulator import CompositeEmulator, MotionEmulator, MotionLibrary, Part
from emulator.judge.paper import prepared, table_1, table_2
from emulator.synthetic.tasks import make
from emulator.synthetic.walking import make_walks

N = 12
CONDITIONS = (None, {"duration_s": 2.5}, {"log_duration_shift": 0.2}, {"pace": 1.15})
WALKS = (None, {"distance_m": 3.0}, {"cycles": 4}, {"length_s": 5.0}, {"distance_m": 4.0, "speed_m_per_s": 1.1})
Figures = Iterator[tuple[str, np.ndarray]]


def figures(libraries: Path) -> Figures:
    """Each number or array with its name."""
    shipped = [MotionLibrary.load(path) for path in sorted(libraries.glob("*.npz"))]
    for name, model in fitted().items():
        yield from stored(f"fitted/{name}", MotionLibrary.of(model))
        yield from drawn(f"fitted/{name}", model)
    for library in shipped:
        yield from stored(f"shipped/{'+'.join(library)}", library)
        for task, model in library.items():
            yield from drawn(f"shipped/{task}", model)
    bench, walking = (next(one for one in shipped if len(one) == n) for n in (9, 1))
    parts = (
        Part("reach", bench["reach"]),
        Part("carry", walking["walk"], {"distance_m": 3.0}),
        Part("fasten", bench["fasten"]),
    )
    yield from drawn("composite", CompositeEmulator("carried", parts), (None, {"pace": 1.1}))
    yield from tables()


def fitted() -> dict[str, Any]:
    """A task with marks, one with covariates of few people, and walking."""
    tasks = {"reach": (5, 8, 4), "fasten": (3, 6, 1)}
    models: dict[str, Any] = {
        task: MotionEmulator.fit(make(task, *of[:2], seed=of[2])[0]) for task, of in tasks.items()
    }
    from emulator.cyclic.model import CyclicEmulator

    return models | {"walk": CyclicEmulator.fit(make_walks(3, 3, seed=2)[0], task="walk")}


def stored(name: str, library: MotionLibrary) -> Figures:
    """The bytes that a library is written as."""
    with TemporaryDirectory() as folder:
        library.save(Path(folder) / "library.npz")
        yield f"{name}/bytes", np.frombuffer((Path(folder) / "library.npz").read_bytes(), np.uint8)


def drawn(name: str, model: Any, conditions: tuple[Any, ...] | None = None) -> Figures:
    """Times, coefficients and bodies of anybody, a new worker and a known one, under each condition."""
    rng = np.random.default_rng(7)
    asked = conditions or (WALKS if type(model).__name__ == "CyclicEmulator" else CONDITIONS)
    workers = {"anybody": None, "new": model.draw_worker(rng, {"height_m": 1.62, "pace": 1.05})}
    if model.workers:
        workers["known"] = model.workers[0]
    for who, worker in workers.items():
        yield f"{name}/{who}/mean_s", np.array(model.mean_duration_s(worker))
        for condition in asked:
            some = model.sample(N, rng, worker=worker, condition=condition)
            head = f"{name}/{who}/{condition}"
            yield f"{head}/duration_s", some.duration_s
            yield f"{head}/scores", some.scores
            yield f"{head}/mark_s", some.mark_s
            yield f"{head}/positions_m", some[:3].positions_m(n_times=17)
            yield f"{head}/directions", some[1].directions(times_s=np.array([-1.0, 0.0, 0.7, 1e3]))
            yield f"{head}/path", some[2:4].path(n_times=9)


def tables() -> Figures:
    """Tables 1 and 2 of the paper, on a made task."""
    made = prepared(make("reach", 4, 5, seed=3)[0])
    for table in (table_1(made), table_2(made)):
        yield (
            f"table {table.number}",
            np.array([[cell for cell in row if not isinstance(cell, str)] for row in table.rows]),
        )


if __name__ == "__main__":
    out, libraries = (Path(word) for word in sys.argv[1:])
    np.savez(out, **{name.replace("/", "|"): array for name, array in figures(libraries)})
