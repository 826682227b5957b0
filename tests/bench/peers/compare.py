"""Which models there are, the check of every answer, the rounds of timing, and the table."""

import gc
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType

from bench.peers import answers
from bench.peers.times import Given, drawn, given

CHECKED_S = 800.0
"""Horizon of the check against exact answers."""
MOST_ERRORS = 4.0
"""Standard errors that the answer of a timed run may lie off the long run."""


GIVEN, SEEDED, NAMED, ITS_OWN = range(4)
"""Where an entry's numbers come from: what draws them one by one; a seed, or lists of them; opsim's named streams; from
nowhere but itself, so that it is not compared job by job, but with the long run only."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One simulator. until_s : for each model it can say, a horizon that takes it about a second.

    What is compiled takes 0.05 s and more, for the memory of an event log.
    """

    label: str
    module: str
    package: str
    until_s: dict[str, float]
    luck: int = GIVEN


ENTRIES = (
    Entry("SimPy by hand", "in_simpy", "simpy", {"mm1": 100_000, "line": 20_000, "pool": 6_000}),
    Entry("SimPy lean", "in_simpy_lean", "simpy", {"mm1": 100_000, "pool": 10_000}),
    Entry("opsim", "in_opsim", "opsim", {"mm1": 40_000, "line": 10_000, "pool": 5_000}, NAMED),
    Entry("opsim, manned", "in_opsim", "opsim", {"mm1_manned": 40_000, "line_manned": 8_000}, NAMED),
    Entry("opsim fast", "in_opsim_fast", "numba", {"mm1": 400_000, "line": 40_000, "pool": 20_000}, NAMED),
    Entry("fast, manned", "in_opsim_fast", "numba", {"mm1_manned": 200_000, "line_manned": 20_000}, NAMED),
    Entry("cimba", "in_cimba", "cimba", {"mm1": 400_000, "line": 40_000, "pool": 20_000}, ITS_OWN),
    Entry("numba loop", "in_numba", "numba", {"mm1": 1_000_000, "line": 100_000, "pool": 40_000}, SEEDED),
    Entry("Ciw", "in_ciw", "ciw", {"mm1": 40_000, "line": 4_000}),
    Entry("salabim", "in_salabim", "salabim", {"mm1": 4_000, "line": 3_000, "pool": 600}),
    Entry("Simantha", "in_simantha", "simantha", {"line": 6_000}),
    Entry("simprocesd", "in_simprocesd", "simprocesd", {"mm1": 20_000, "line": 4_000}),
    Entry("FactorySimPy", "in_factorysimpy", "factorysimpy", {"mm1": 10_000, "line": 1_600}),
)
MODELS = ("mm1", "line", "pool")


@dataclass(frozen=True, slots=True)
class Runner:
    """One model of one simulator that is installed. ``run(seed)`` gives jobs finished and the answer."""

    label: str
    model: str
    variant: str
    until_s: float
    function: Callable
    luck: int = GIVEN

    def run(self, seed: int) -> tuple[int, float]:
        return self.function(self.until_s, drawn(self.model, seed) if self.luck == GIVEN else seed)


def installed(package: str) -> bool:
    return find_spec(package) is not None


def runners() -> list[Runner]:
    """Every model of every simulator that is installed and can be given its numbers, model after model."""
    return [runner for runner in _all_runners() if runner.luck != ITS_OWN]


def by_themselves() -> list[Runner]:
    """The models that draw for themselves."""
    return [runner for runner in _all_runners() if runner.luck == ITS_OWN]


def _all_runners() -> list[Runner]:
    present = [entry for entry in ENTRIES if installed(entry.package)]
    for entry in sorted(present, key=lambda entry: entry.luck != ITS_OWN):  # cimba's before all others of numba
        import_module(f"bench.peers.{entry.module}")
    return [
        Runner(entry.label, model, variant, until_s, getattr(_module(entry.label), variant), entry.luck)
        for model in MODELS
        for entry in present
        for variant, until_s in entry.until_s.items()
        if variant.split("_")[0] == model
    ]


def _module(label: str) -> ModuleType:
    name = next(entry.module for entry in ENTRIES if entry.label == label)
    return import_module(f"bench.peers.{name}")


def exact(runner: Runner, seed: int = 5) -> tuple[tuple[int, float], tuple[int, float]]:
    """What a model answers to given numbers, and what it must answer: the same jobs, the same time or rate."""
    n = int(8 * CHECKED_S)
    if runner.luck != NAMED:
        numbers = given(runner.model, seed, n)
        found = runner.function(CHECKED_S, numbers.times() if runner.luck == GIVEN else numbers)
        return found, getattr(answers, runner.model)(CHECKED_S, numbers)
    numbers = _module(runner.label).numbers(runner.variant, CHECKED_S, seed, n)
    found = runner.function(CHECKED_S, seed)
    if runner.model == "pool":
        return found, answers.pool(CHECKED_S, numbers, _by_worker(numbers), choose=min)
    return found, getattr(answers, runner.model)(CHECKED_S, numbers)


def agree(found: tuple[int, float], wanted: tuple[int, float]) -> bool:
    """The same number of jobs, and times equal to nine digits."""
    return found[0] == wanted[0] and abs(found[1] - wanted[1]) <= 1e-9 * wanted[1]


def jobs_per_cpu_s(runner: Runner, seed: int) -> float:
    """Speed of one run, its answer checked against the long run."""
    gc.collect()
    started = time.process_time()
    found = runner.run(seed)
    spent = time.process_time() - started
    errors = answers.long_run_error(runner.model, found)
    assert errors < MOST_ERRORS, f"{runner.label}, {runner.variant}: {found[1]:.4g} is {errors:.1f} standard errors off"
    return found[0] / spent


def _by_worker(numbers: Given) -> Callable[[int], float]:
    """opsim's durations belong to the worker who spends them."""
    streams = [iter(column) for column in numbers.services]
    return lambda worker: next(streams[worker])
