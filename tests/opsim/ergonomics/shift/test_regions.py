import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.shift.day import fold, said_of
from opsim.ergonomics.shift.ledger import REGIONS, Regions, points
from opsim.kpi.exposure import exposure

CELL = """
opsim: 1
name: cell
run: {start: Mon 06:30, horizon: 10 min, warm_up: 1 min, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
libraries: {bench: libraries/bench_work.npz}
tasks:
  stoop: {emulator: bench/stoop, load: 12 kg, handling: {forearm: end, legs: unbalanced}}
  place: {emulator: bench/place}
  label: {fixed: 4 s}
stations: {low: {at: here, tasks: [stoop, place, label], servers: 2, buffer: 2}}
products: {p: {route: [low]}}
release: {kind: saturated}
workers: {ana: {skills: {low: 1.0}}, ben: {skills: {low: 0.8}}}
"""


class Kept:
    def __init__(self):
        self.seen = []

    def add(self, frames, scores):
        self.seen.append((frames, scores))


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    kept, regions = Kept(), Regions(plan)
    fold(log, plan, [kept, regions])
    return log, plan, kept.seen, regions


def test_points_are_those_of_the_explanation_of_each_posture(cell):
    _, plan, seen, _ = cell
    frames, _ = seen[0]
    for task in np.unique(frames.task[frames.known]).tolist():
        rows = np.flatnonzero((frames.task == task) & frames.known)[:: max(1, (frames.task == task).sum() // 4)]
        some, said = frames.some(rows), said_of(task, plan)
        found = points(some, said, plan.ergonomics)
        for n in range(len(some)):
            flags = {name: bool(getattr(some, name)[n]) for name in ("repeated", "static", "carrying")}
            drives = explain(some.measures[n], said, plan.ergonomics, **flags)["rula"]["drives"]
            assert found[n] == pytest.approx([drives.get(region, 0.0) for region in REGIONS], abs=1e-9)


def test_all_regions_together_are_the_time_at_that_score(cell):
    _, plan, seen, regions = cell
    for column, level in enumerate((5, 7)):
        for rank in range(len(plan.workers)):
            own = [frames.seconds[scores.rula[:, 0] >= level].sum() for frames, scores in seen if frames.worker == rank]
            assert regions.seconds[rank, :, column].sum() == pytest.approx(sum(own), rel=1e-9)
    assert regions.seconds.sum() > 0 and (regions.seconds >= 0).all()


def test_figures_of_regions_sum_to_the_minutes_at_that_score(cell):
    log, plan, *_ = cell
    asked = ("exposure_by_region", "rula_from_5_min_per_h")
    found = {(f.kpi, f.subject, f.part): f.value for f in exposure(log, plan, asked)}
    dealt = sum(found["exposure_by_region", region, "rula_from_5"] for region in REGIONS)
    assert dealt == pytest.approx(found["rula_from_5_min_per_h", "", ""], rel=1e-9)


def test_a_load_brings_in_points_only_while_it_is_in_the_hands(cell):
    _, plan, seen, _ = cell
    frames, _ = seen[0]
    rows = np.flatnonzero((frames.task == 1) & frames.known)[:3]
    some = frames.some(rows)
    said = said_of(1, plan)
    empty = points(type(some)(some.worker, **{**columns(some), "carrying": np.zeros(3, bool)}), said, plan.ergonomics)
    full = points(some, said, plan.ergonomics)
    assert (empty[:, REGIONS.index("load")] == 0).all() and (full[:, REGIONS.index("load")] > 0).all()


def columns(frames):
    return {name: getattr(frames, name) for name in frames.__dataclass_fields__ if name != "worker"}
