"""A results folder, run once for all tests that ask it."""

from functools import lru_cache
from pathlib import Path
from tempfile import mkdtemp

from opsim.results import variants_in
from opsim.scenario.read import scenarios_in
from opsim.study import run_scenario

CELL = """
opsim: 1
name: Little cell
run: {start: Tue 06:00, horizon: 10 min, replications: 2, seed: 7, posture: off}
libraries: {moves: libraries/public_movements.npz, walking: libraries/walking.npz}
layout: {places: {here: [0 m, 0 m], there: [6 m, 0 m]}}
tasks:
  lift: {emulator: moves/deep_squat}
  label: {fixed: 20 s}
stations:
  unload: {at: here, tasks: [lift], buffer: 4}
  pack: {at: there, tasks: [label], buffer: 4}
products: {carton: {route: [unload, pack]}}
release: {kind: saturated}
workers: {ana: {height: 1.62 m, mass: 58 kg, walk: 1.2 m/s, skills: {unload: 1.0, pack: 1.0}}}
walking: {emulator: walking/walk}
outputs: [throughput_per_h, worker_states]
overrides: {near: {layout.places.there: [3 m, 0 m]}}
scenarios: {base: [], near: [near]}
"""


@lru_cache
def results():
    """The folder of a run of two variants, two replications each, with bodies; not to be changed."""
    folder = Path(mkdtemp(prefix="results"))
    for name, loaded in scenarios_in(CELL.encode(), folder / "cell.yaml").items():
        run_scenario(loaded, folder=folder / "out" / name, processes=1)
    return folder / "out"


def variants():
    return variants_in(results())
