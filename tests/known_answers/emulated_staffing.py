"""The same line, its work emulated: a library of made motions whose share of variance between people is known."""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from known_answers.cases import HERE, Case
from known_answers.staffing import EXPECTED
from threadpoolctl import threadpool_limits

SHARE = {"none": 0.0, "quarter": 0.25, "half": 0.5}
CV = 0.3
N_PEOPLE, N_EACH, FEWER = 300, 6, 5
"""Enough that the fitted CV and share are the true ones within a few per cent. That people do not differ is learnt
from many repetitions of ``FEWER`` times fewer people: the error of a share of 0 is sqrt(2 / (n k (k - 1))), n people
and k repetitions each (Donner 1986), 0.015 of 300 people, 0.006 of 60; and 0.015 costs 1.6 % of the rate already."""


def library(n_people: int = N_PEOPLE, n_each: int = N_EACH, processes: int = 1):
    """A reach at each share, fitted to made repetitions; name of the variant -> emulator."""
    from emulator import MotionLibrary

    made = MotionLibrary.of()
    with ProcessPoolExecutor(min(processes, len(SHARE)), mp_context=get_context("spawn")) as pool:
        run = pool.map if processes > 1 else map
        for emulator in run(partial(_fitted, n_people=n_people, n_each=n_each), SHARE):
            made = made.add(emulator)
    return made


def _fitted(name: str, n_people: int, n_each: int):
    from emulator import MotionEmulator
    from emulator.synthetic import tasks as synthetic

    share = SHARE[name]
    shape = (n_people, n_each) if share else (n_people // FEWER, n_each * FEWER)
    with threadpool_limits(1, user_api="blas"):
        motions, _ = synthetic.make("reach", *shape, seed=1, between_share=share, duration_cv=CV)
        return MotionEmulator.fit(replace(motions, task=name), n_times=21, n_knots=6, n_components=4)


def written(
    folder: Path, n_people: int = N_PEOPLE, n_each: int = N_EACH, processes: int = 1
) -> tuple[tuple[Case, ...], dict[str, float]]:
    """The library and ``staffing.yaml`` with its work emulated, in a folder: their cases, and mean seconds of work."""
    made = library(n_people, n_each, processes)
    made.save(folder / "made.npz")
    text = (HERE / "staffing.yaml").read_text()
    for old, new in (
        ("horizon: 1400 s, warm_up: 200 s", "horizon: 2240 s, warm_up: 320 s"),
        ("tasks:\n", "libraries: {made: made.npz}\ntasks:\n"),
        ("{dist: lognormal, mean: 1 s, cv: 0.3}", "{emulator: made/none}"),
        ("{tasks.work.between_share: 0.25}", "{tasks.work.emulator: made/quarter}"),
        ("{tasks.work.between_share: 0.5}", "{tasks.work.emulator: made/half}"),
    ):
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    (folder / "emulated.yaml").write_text(text)
    cases = tuple(Case(str(folder / "emulated"), name, "throughput_per_h", (), few=60) for name in EXPECTED)
    return cases, {name: model.mean_duration_s() for name, model in made.items()}


def rates(runs, case: Case, mean_s: float):
    """(replications,) throughput times mean time, one a workforce."""
    return runs[case.file, case.variant]["throughput_per_h"] * mean_s / 3600.0
