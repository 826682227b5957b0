"""A task of several motions in a scenario: times add up, one person, known to everything that reads tasks."""

from pathlib import Path

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.trunk import trunk_exposure
from opsim.laws.audit import CHECKS, audit
from opsim.plan import compile_plan
from opsim.plan.warnings import risks_of
from opsim.problems import ScenarioError
from opsim.scenario import read_scenarios
from opsim.scenario.read import scenarios_in
from opsim.streams import stream
from opsim.study.assumptions import assumptions_of, task_sources
from opsim.subjects.tasks.from_scenario import emulators_of, same_task
from opsim.subjects.tasks.warnings import unread, wide_joins
from opsim.worker_effects import worker_effect

KIT = """
opsim: 1
name: Kit
run: {horizon: 30 min, seed: 3}
libraries: {work: libraries/bench_work.npz}
layout: {places: {bench: [0 m, 0 m]}}
tasks:
  screw: {emulator: work/fasten}
  kit: {motions: [work/reach, work/pick, work/place, {emulator: work/fasten, repeat: 2}]}
stations: {pack: {at: bench, tasks: [kit, screw], buffer: 1}}
products: {carton: {route: [pack]}}
release: {kind: saturated}
workers: {ana: {height: 1.6 m, skills: {pack: 1.0}}, ben: {person: w3, skills: {pack: 1.0}}}
outputs: [throughput_per_h, trunk_flexion_share]
"""


def read(text=KIT):
    return scenarios_in(text.encode(), Path("kit.yaml"))["base"]


@pytest.fixture(scope="module")
def loaded():
    return read()


@pytest.fixture(scope="module")
def plan(loaded):
    return compile_plan(loaded)


def model_of(plan, name):
    return next(task.model for task in plan.tasks if task.name == name)


def effect_of(plan, task, worker="ana"):
    return worker_effect(model_of(plan, task), task, worker, plan.seed, 0)


def test_the_mean_is_the_sum_over_the_motions_with_their_repeats(plan):
    kit = model_of(plan, "kit")
    means = {name: model.mean_duration_s() for name, model in kit.distinct.items()}
    assert kit.mean_duration_s() == pytest.approx(sum(means.values()) + means["screw"], rel=1e-12)
    assert kit.mark_names[-2:] == ("fasten.2.start", "fasten.2.stop")


def test_who_fastens_inside_a_kit_is_who_fastens_at_the_bench(loaded, plan):
    assert same_task("work/fasten", loaded) == "screw" and same_task("work/reach", loaded) == "work/reach"
    inside = effect_of(plan, "kit").effects
    assert set(inside) == {"work/reach", "work/pick", "work/place", "screw"}
    assert np.array_equal(inside["screw"].z, effect_of(plan, "screw").z)


def test_the_same_pace_in_all_tasks_reaches_into_the_motions(plan):
    kit = model_of(plan, "kit")
    slow = worker_effect(kit, "kit", "ana", plan.seed, 0, None, "same_pace")
    means = [model.mean_duration_s(slow.effects[key]) / model.mean_duration_s() for key, model in kit.distinct.items()]
    assert all(m > 1 for m in means) or all(m < 1 for m in means)


@pytest.mark.parametrize("variability", ["none", "between_only", "within_only", "shuffled"])
def test_every_switch_of_variability_takes_a_task_of_motions(loaded, variability):
    plan = compile_plan(read(KIT.replace("seed: 3", f"seed: 3, variability: {variability}")))
    kit, full = model_of(plan, "kit"), model_of(compile_plan(loaded), "kit")
    drawn = kit.sample(4, stream(1, 0, "x"), worker=effect_of(plan, "kit"))
    assert kit.mean_duration_s() == pytest.approx(full.mean_duration_s())
    assert drawn.positions_m(n_times=7).shape == (4, 7, 21, 3) and drawn.bone_length_m.shape == (4, 20)
    spread = np.ptp(drawn.duration_s)
    assert spread == 0 if variability in ("none", "between_only") else spread > 0.1


def test_a_run_obeys_the_laws_and_all_of_its_work_has_a_posture(plan):
    log = run_plan(plan)
    assert audit(log, plan) == CHECKS
    exposure = trunk_exposure(log, plan)
    assert exposure.unmeasured_s.sum() == 0 and exposure.measured_s.sum() > 1000


def test_what_stands_behind_it_is_told(loaded, plan):
    row = next(row for row in task_sources(loaded, plan) if row["task"] == "kit")
    assert row["emulated"] and row["library"] == "libraries/bench_work.npz" and row["n_workers"] == 12
    assert row["library_task"] == "work/reach, work/pick, work/place, work/fasten x 2"
    assert emulators_of(loaded.scenario.tasks["kit"], loaded) == [
        "work/reach",
        "work/pick",
        "work/place",
        "work/fasten",
    ]
    said = [says for topic, says in assumptions_of(loaded, plan) if says.startswith("kit: its motions follow")]
    assert len(said) == 1 and "work/pick" in said[0] and "nobody was recorded" in said[0]


def test_a_recorded_person_is_looked_for_in_the_motions_too(plan):
    only = KIT.replace("  screw: {emulator: work/fasten}\n", "").replace("tasks: [kit, screw]", "tasks: [kit]")
    assert read(only).scenario.workers["ben"].person == "w3" and unread(plan) == []
    with pytest.raises(ScenarioError, match="no person 'w33' was recorded"):
        read(only.replace("person: w3", "person: w33"))


def test_postures_asked_for_have_bodies_where_a_task_is_motions(loaded):
    assert not [risk for risk in risks_of(loaded.scenario) if "nothing will be measured" in risk]


def test_a_join_of_postures_far_apart_is_warned_of_in_degrees(plan):
    apart = KIT.replace("work/reach, work/pick", "moves/shoulder_abduction, moves/deep_squat").replace(
        "libraries: {", "libraries: {moves: libraries/public_movements.npz, "
    )
    (warning,) = wide_joins(compile_plan(read(apart.replace("ben: {person: w3,", "ben: {"))))[:1]
    assert warning.startswith("kit: shoulder_abduction ends far from where deep_squat begins: the bone to")
    assert "degrees away (more than 110)" in warning
    assert wide_joins(plan) == []


def test_motions_of_other_bodies_are_refused_where_they_stand(monkeypatch):
    from opsim.subjects.tasks import checks as motions

    monkeypatch.setattr(
        motions, "library_skeletons", lambda path: {"reach": (("a", "b"), (-1, 0)), "pick": (("a", "c"), (-1, 0))}
    )
    with pytest.raises(
        ScenarioError, match=r"kit.yaml:9:31: tasks.kit.motions\[1\]: 'work/pick' has no b and also c, unlike"
    ):
        read()


def test_a_walk_inside_a_task_takes_its_length_over_the_worker_s_own_speed():
    plan = compile_plan(read_scenarios("kitting")["base"])
    kit, workers = model_of(plan, "kit"), {worker.name: worker for worker in plan.workers}
    at = kit.labels.index("walk")
    for name in ("rosa", "sven"):
        body = workers[name].body
        effect = worker_effect(kit, "kit", name, plan.seed, 0, body)
        drawn = kit.sample(200, stream(1, 0, name), worker=effect)
        assert drawn.part_s[:, at].mean() == pytest.approx(3.0 / body.walk_m_per_s, rel=0.03)
        gone_m = np.diff(drawn[:3].root_m(times_s=drawn.stop_s[:3, at - 1 : at + 1]), axis=1)[:, 0, :2]
        assert np.linalg.norm(gone_m, axis=-1) == pytest.approx([3.0] * 3, abs=0.05)


def test_who_walks_inside_a_kit_is_who_walks_between_stations():
    from opsim.ergonomics.walking import walker

    plan = compile_plan(read_scenarios("kitting")["base"])
    rosa = plan.workers[0]
    inside = worker_effect(model_of(plan, "kit"), "kit", rosa.name, plan.seed, 0, rosa.body).effects["walk"]
    between = walker(plan, 0, 0)
    assert np.array_equal(inside.bone_length_m, between.bone_length_m) and np.array_equal(inside.z, between.z)


def test_drawing_times_costs_no_more_than_its_parts_and_a_fifth(plan):
    from time import process_time

    kit, effect = model_of(plan, "kit"), effect_of(plan, "kit")

    def whole():
        kit.sample(64, np.random.default_rng(0), worker=effect).duration_s.tolist()

    def parts():
        rng = np.random.default_rng(0)
        for part in kit.parts:
            part.model.sample(64, rng, worker=effect.effects[part.task]).duration_s.tolist()

    def best(draw):
        times = []
        for _ in range(60):
            start = process_time()
            draw()
            times.append(process_time() - start)
        return min(times)

    assert min(best(whole) / best(parts) for _ in range(3)) < 1.2
