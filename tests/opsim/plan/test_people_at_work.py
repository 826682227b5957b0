"""What a scenario says of hands, scoring and human effects, as the Plan has it."""

import plans
import pytest

from opsim.ergonomics.options import USUAL, Thresholds
from opsim.human.catalogue import entry
from opsim.plan.tasks import NOT_SAID, Handling, Moment
from opsim.plan.workers import NO_EFFECTS

CELL = """
opsim: 1
name: hands
run: {start: Tue 07:30, horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
shifts: {early: {from: '06:00', to: '14:00'}}
tasks:
  make: {emulator: work/fasten, load: 2 kg, loaded: {from: start, to: 0.8}, handling: {grip: fair, rapid: false}}
  look: {fixed: 9 s}
stations: {s1: {at: a, tasks: [make, look]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers:
  w10: {shift: early, skills: {s1: 1}, experience: {make: 40}}
  w2: {skills: {s1: 1}, experience: {look: 3}}
  w3: {shift: early, absence: 0, skills: {s1: 1}}
"""
PLAIN = CELL.replace("experience: {make: 40}", "").replace("experience: {look: 3}", "")
LOOK, MAKE = 0, 1


def plan(more=""):
    return plans.plan(CELL + more)


def test_what_is_said_of_hands_stands_with_the_task_and_the_rest_is_not_said():
    marks = plans.plan(CELL).tasks[MAKE].model.mark_names
    said = plan().tasks[MAKE].handling
    assert said == Handling(
        load_kg=2.0, grip="fair", rapid=False, start=Moment(mark=marks.index("start")), end=Moment(share=0.8)
    )
    assert plan().tasks[LOOK].handling is NOT_SAID


def test_a_plain_scenario_has_the_usual_options_and_no_effects():
    plain = plans.plan(PLAIN)
    assert (plain.ergonomics, plain.human, plain.posture) == (USUAL, NO_EFFECTS, True)
    assert [worker.absence for worker in plain.workers] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("word", "looked_at"), [("off", False), ("false", False), ("on", True), ("true", True), ("'off'", False)]
)
def test_off_is_off_whoever_wrote_it(word, looked_at):
    assert plans.plan(CELL.replace("horizon: 1 h", f"horizon: 1 h, posture: {word}")).posture is looked_at


def test_angles_are_degrees_to_the_bit_and_lengths_metres():
    thresholds = plan("ergonomics: {thresholds: {twist: 15 deg, side: 0.2 rad, across: 4 cm}}\n").ergonomics.thresholds
    assert thresholds == Thresholds(twist=15.0, side=11.459155903, across_m=0.04)


def test_every_fork_arrives():
    options = plan(
        "ergonomics: {rate: 6, arm_reference: gravity, rula: {table_a: worksheet2000, force: worksheet}, "
        "owas: {disputed: [4132, '3373', 4132]}, waiting: upright}\n"
    ).ergonomics
    assert (options.rate_hz, options.arm_reference, options.waiting) == (6.0, "gravity", "upright")
    assert (options.rula_table_a, options.rula_force) == ("worksheet2000", "worksheet")
    assert options.owas_disputed == ("3373", "4132")


def test_effects_are_the_models_of_the_catalogue_with_what_was_said():
    human = plan(
        "human: {acts_on: time, learning: {model: wright, rate: 0.9}, "
        "fatigue: {model: lffrm, recovers_half_in: 10 min}, "
        "circadian: {peak: '16:00'}, rest: {above: 0.6, until: 0.1}}\n"
    ).human
    assert human.learning == entry("learning", "wright").cls(rate=0.9)
    assert human.fatigue == entry("fatigue", "lffrm").cls(recovers_half_in_s=600.0)
    assert human.circadian == entry("circadian").cls(peak_s=16 * 3600.0)
    assert human.rest == entry("rest").cls(above=0.6, until=0.1)
    assert (human.acts_on, human.forgetting, human.errors) == ("time", None, None)
    assert human.start_s == (24 + 7.5) * 3600


def test_experience_stands_by_natural_order_of_workers_and_tasks():
    """w2, w3, w10; look, make."""
    assert plan("human: {learning: {model: wright}}\n").human.experience == ((3.0, 0.0), (0.0, 0.0), (0.0, 40.0))


def test_absence_of_all_is_of_everybody_with_a_shift_who_does_not_say_his_own():
    absent = {worker.name: worker.absence for worker in plan("human: {absence: 0.1}\n").workers}
    assert absent == {"w2": 0.0, "w3": 0.0, "w10": 0.1}
