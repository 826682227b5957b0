"""Human effects together, on both engines: in their order, neutral and not, on floors of many blocks.

The time of day on both engines.

Errors by fatigue on both engines.

Fatigue on both engines: how long it takes to tire, how long to recover, in pieces and as a whole.

Learning and forgetting on both engines.

Pace that depends on the state of the line, on both engines.

Rest by need on both engines: it begins when somebody comes free, and ends with him rested, or called away.

Rules by exposure on both engines; the rates are Python's, as everybody has them.
"""

import numpy as np
import pytest
from human_plans import LINE, NEUTRAL, planned, shipped
from made.pool import POOL
from twins import of_both, twins

from opsim.engine.fast_engine import run_plan
from opsim.ergonomics.shift.worst import DoseRates
from opsim.log import BAD, BREAK, FINISH, HELD, OFF, REST, REWORK, WORK
from opsim.subjects.human.catalogue import models_of

ALL = """
human:
  ACTS
  learning: {model: plateau, rate: 0.8, measured_at: 7}
  forgetting: {model: lfcm, forgotten_in: 30 d, least_pause: 2 min}
  state_pace: {model: schultz, faster: 0.2, slower: 0.1}
  circadian: {amplitude: 0.1, peak: '03:00'}
  fatigue: {model: lffrm, tires_half_in: 20 min, recovers_half_in: 5 min}
  rest: {above: 0.5, until: 0.2}
  errors: {at_full_fatigue: 0.3}
"""


@pytest.mark.parametrize(("name", "hours"), [("relief_worker", 3.0), ("paced_line", 1.5), ("solder_rework", 2.0)])
def test_all_effects_at_once_are_those_of_the_reference(name, hours):
    for acts_on in ("posture", "time"):
        of_both(shipped(name, hours, ALL.replace("ACTS", f"acts_on: {acts_on}")))


def test_neutral_effects_change_nothing_here_either():
    neutral, without = (of_both(shipped("serial_line", 2.0, human)) for human in (NEUTRAL, ""))
    assert neutral["end_s"].tolist() == without["end_s"].tolist()


@pytest.mark.parametrize("amplitude", [0, 0.05, 1])
def test_people_go_by_the_clock_as_in_the_reference(amplitude):
    log = of_both(shipped("night_shift", 8.0, f"human: {{circadian: {{amplitude: {amplitude}, peak: '16:48'}}}}"))
    assert bool(log.of(WORK)["pace_shift"].any()) == bool(amplitude)


INSPECTED = LINE.replace(
    "c: {at: three, tasks: [paint], buffer: 2}",
    "c: {at: three, tasks: [paint], buffer: 2, yield: 0.95, inspect: {finds: 0.5, then: {rework: c}}}",
).replace("{b: 1.0}", "{b: {pace: 1.0, quality: 0.9}}")
TIRED = "fatigue: {model: lffrm, tires_half_in: 1 h, recovers_half_in: 10 min}, "


@pytest.mark.parametrize(("fatigue", "share"), [(TIRED, 0.4), (TIRED, 0), (TIRED, 1)])
def test_the_tired_leave_the_same_defects_as_in_the_reference(fatigue, share):
    log = of_both(planned(INSPECTED, f"human: {{{fatigue}errors: {{at_full_fatigue: {share}}}}}"))
    assert np.count_nonzero(log["kind"] == REWORK) > 3
    assert np.count_nonzero((log["kind"] == FINISH) & (log["cause"] == BAD)) > 3


FLOOR = """
opsim: 1
name: tired
run: {start: Mon 06:00, horizon: 90 min, seed: 4}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m]}}
shifts: {day: {from: '06:00', to: '07:20', breaks: {tea: {at: '06:31', lasts: 4 min}}, at_break: resume_any}}
tasks: {cut: {dist: lognormal, mean: 50 s, cv: 0.3}, drill: {dist: gamma, mean: 30 s, cv: 0.5, repeat: 2}}
stations:
  one: {at: a, tasks: [cut], buffer: 2, breakdowns: {jam: {every: {fixed: 4 min}, repair: {fixed: 40 s}}}}
  two: {at: b, tasks: [drill, cut], buffer: 1}
products: {p: {share: 0.5, route: [one, two]}, q: {share: 0.5, route: [two], priority: 1}}
release: {kind: poisson, every: 70 s}
workers:
  ana: {shift: day, walk: 1 m/s, skills: {one: 1.0, two: 0.8}}
  ben: {skills: {one: 0.9, two: 1.1}}
"""
FAST = "tires_half_in: 10 min, recovers_half_in: 3 min, slows: 0.7"


@pytest.mark.parametrize("acts_on", ["posture", "time"])
def test_people_tire_as_they_do_in_the_reference(acts_on):
    log = of_both(planned(FLOOR, f"human: {{acts_on: {acts_on}, fatigue: {{model: lffrm, {FAST}}}}}"))
    work = log.of(WORK)
    assert (work["progress_to"] < 1.0).any() and len(log.of(BREAK))
    assert (work["pace_shift"].max() > 0.1) == (acts_on == "posture")


@pytest.mark.parametrize("fatigue", ["tires_half_in: never", "slows: 0", "tires_half_in: 1 s, slows: 10"])
def test_so_do_those_who_never_tire_or_at_once(fatigue):
    of_both(planned(FLOOR, f"human: {{fatigue: {{model: lffrm, {fatigue}}}}}"))


BENCH = """
opsim: 1
name: bench
run: {start: Fri 13:00, horizon: 2 d 17 h 30 min, seed: 2}
layout: {places: {here: [0 m, 0 m], there: [9 m, 0 m]}}
tasks: {fit: {dist: lognormal, mean: 40 s, cv: 0.3, repeat: 2}, look: {fixed: 15 s}}
stations:
  one: {at: here, tasks: [fit, look], buffer: 1, breakdowns: {jam: {every: {dist: exponential, mean: 3 min}, repair: {fixed: 70 s}}}}
  two: {at: there, tasks: [look, fit], buffer: 2}
products: {part: {route: [one, two]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, days: [Mon, Fri], breaks: {tea: {at: 13:20, lasts: 3 min}}, at_break: resume_any}}
workers:
  ana: {skills: {one: 1.0, two: 0.9}, shift: early, experience: {fit: 7}}
  ben: {skills: {one: 1.1, two: 1.0}, shift: early, walk: 1 m/s}
"""  # noqa: E501
LEARNING = "learning: {model: wright, rate: 0.8, measured_at: 12}"


@pytest.mark.parametrize("model", models_of("learning"))
def test_people_learn_as_they_do_in_the_reference(model):
    log = of_both(planned(BENCH, f"human: {{learning: {{model: {model}}}}}"))
    seconds = log.of(WORK).duration_s
    assert len(seconds) > 100 and seconds[:20].mean() > seconds[-100:].mean()


@pytest.mark.parametrize(
    "forgetting",
    ["forgotten_in: never", "forgotten_in: 40 d", "forgotten_in: 1 d", "least_pause: 0 s, forgotten_in: 30 min"],
)
def test_people_forget_as_they_do_in_the_reference(forgetting):
    """Over a weekend, in breaks, and where they are broken off before anything is done, or wait for a repair."""
    log = of_both(planned(BENCH, f"human: {{{LEARNING}, forgetting: {{model: lfcm, {forgetting}}}}}"))
    pieces = log.of(WORK)
    assert (pieces["progress_to"] < 1.0).sum() > 2 and len(log.of(HELD)) > 2


HUMAN_PACE_FLOOR = """
opsim: 1
name: pace
run: {horizon: 1 h, seed: 6}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m]}}
tasks: {t: {dist: lognormal, mean: 30 s, cv: 0.5}, u: {dist: lognormal, mean: 40 s, cv: 0.4}}
stations:
  first: {at: a, tasks: [t], buffer: 2}
  left: {at: b, tasks: [u], buffer: 0}
  right: {at: b, tasks: [u], buffer: 3, servers: 2}
  last: {at: a, tasks: [t]}
products:
  p: {share: 0.6, route: [first, [left, right], last]}
  q: {share: 0.4, route: [right, last]}
release: {kind: poisson, every: 35 s}
workers:
  ana: {skills: {first: 1, left: 1, right: 1}}
  ben: {skills: {right: 0.9, last: 1}, walk: 1 m/s}
  cem: {skills: {left: 1, last: 1.1}}
human: {state_pace: {model: schultz, faster: 0.3, slower: 0.2, full_at: 4}}
"""


@pytest.mark.parametrize("model", ["faster: 0.3, slower: 0.2, full_at: 4", "faster: 2", "faster: 0, slower: 0"])
def test_people_go_by_the_buffers_before_and_behind_them_as_in_the_reference(model):
    log = twins(HUMAN_PACE_FLOOR, ("faster: 0.3, slower: 0.2, full_at: 4", model))
    shifts = set(log.of(WORK)["pace_shift"].tolist())
    assert len(shifts) > 5 or model == "faster: 0, slower: 0"


def test_who_comes_to_help_is_asked_before_he_has_the_job():
    from twins import of_both

    of_both(shipped("paced_line", 1.0, "human: {state_pace: {model: schultz, faster: 0.4}}"))


HUMAN_REST_FLOOR = """
opsim: 1
name: rests
run: {start: Mon 06:00, horizon: 4 h, seed: 3}
layout: {places: {x: [0 m, 0 m], y: [4 m, 0 m]}}
tasks: {t: {dist: lognormal, mean: 3 min, cv: 0.4}, u: {fixed: 2 min}}
stations: {a: {at: x, tasks: [t], buffer: 2}, b: {at: y, tasks: [u], buffer: 2}}
products: {p: {share: 0.5, route: [a]}, q: {share: 0.5, route: [b, a]}}
release: {kind: poisson, every: 3 min}
shifts: {d: {from: '06:00', to: '07:40', overtime: {most: 70 min}, breaks: {tea: {at: '06:50', lasts: 5 min}}, meetings: {short: {at: '07:11', lasts: 2 min}}}}
workers:
  ana: {shift: d, skills: {a: 1, b: 1}}
  ben: {shift: d, skills: {a: 1, b: 0.8}, walk: 1 m/s}
  cem: {skills: {b: 1}}
human:
  fatigue: {model: lffrm, tires_half_in: 12 min, recovers_half_in: 4 min, slows: 0.1}
  rest: {above: 0.4, until: 0.2}
"""  # noqa: E501


def rests(log):
    return log.where((log["kind"] == BREAK) & (log["cause"] == REST))


@pytest.mark.parametrize("above", ["0.25", "0.4", "0.8", "1"])
def test_people_rest_as_they_do_in_the_reference(above):
    log = twins(HUMAN_REST_FLOOR, ("above: 0.4", f"above: {above}"))
    assert len(rests(log)) > 5 or float(above) > 0.5
    assert len(log.of(OFF)) >= 2


def test_rests_are_cut_short_by_breaks_meetings_and_the_end_of_the_shift():
    """And gone on with after them, where he is too tired still."""
    found = rests(twins(HUMAN_REST_FLOOR, ("recovers_half_in: 4 min", "recovers_half_in: 40 min")))
    assert {50 * 60.0, 71 * 60.0} & set(found["end_s"].tolist())
    assert np.count_nonzero(np.isin(found["start_s"], [55 * 60.0, 73 * 60.0])) > 0


def test_rests_come_before_posts_are_given_out_and_beside_crews():
    turn = "human:", "rotations: {turn: {workers: [ana, ben], posts: [a, b], every: 9 min}}\nhuman:"
    assert len(rests(twins(HUMAN_REST_FLOOR, turn))) > 5


UNEVEN = POOL.replace("cem: {skills: {a: 1, b: 1}}", "cem: {skills: {a: 1, b: 0.7}}").replace(
    "tasks: [heavy], buffer: 5",
    "tasks: [heavy], buffer: 5, breakdowns: {jam: {every: {dist: exponential, mean: 4 min}, repair: {fixed: 60 s}}}",
)
"""Cem is slow at light work, and heavy work breaks off again and again."""
TURN = (
    "allocation: {rule: least_exposed}",
    "rotations: {turn: {workers: [cem, ana, ben], posts: [b, [], a], every: 5 min, rule: least_exposed}}",
)
DOSES_TIRED = ("allocation:", "human: {fatigue: {model: lffrm, tires_half_in: 20 min}}\nallocation:")


@pytest.fixture
def known(monkeypatch):
    """How fast heavy and light work add to a dose; ben gathers it faster."""
    monkeypatch.setattr(DoseRates, "per_s", lambda self, worker, task: (6.0, 2.0, 1.0)[task] + 0.1 * (worker == 1))


@pytest.mark.parametrize("edits", [(), (TURN,), (DOSES_TIRED,), (DOSES_TIRED, TURN)])
def test_work_goes_to_the_least_exposed_as_in_the_reference(known, edits):
    log = twins(UNEVEN, *edits)
    work = log.of(WORK)
    assert len(log.of(FINISH)) > 100 and (work["progress_to"] < 1.0).any()
    assert bool(work["pace_shift"].any()) == (DOSES_TIRED in edits)


def test_where_nobody_knows_a_posture_all_doses_are_0():
    log = twins(UNEVEN)
    assert np.array_equal(log["worker"], twins(UNEVEN, ("least_exposed", "longest_queue"))["worker"])


def test_what_python_raises_when_it_is_asked_is_raised_by_the_run(monkeypatch):
    from plans import plan

    def fails(*_args):
        raise RuntimeError("no such posture")

    monkeypatch.setattr(DoseRates, "per_s", fails)
    for text in (UNEVEN, UNEVEN.replace(*TURN)):
        with pytest.raises(RuntimeError, match="no such posture"):
            run_plan(plan(text))


def test_a_shipped_cell_of_bodies_is_the_same():
    from human_plans import shipped

    of_both(shipped("least_exposed", 0.5))
