"""Rest by need: who is free and too tired rests until he is not, or is called away; never in the middle of a task."""

from dataclasses import replace
from random import Random

import numpy as np
import plans
import pytest
from checked_floors import differ, plan_of
from choices import Lots
from human_plans import LINE, planned
from made.brigades import scenario as brigade
from made.floors import text_of
from made.people_blocks import people_floor_with

from opsim.engine.floor.run import run_plan
from opsim.history import tiredness
from opsim.kpi import figures
from opsim.laws.audit import audit
from opsim.log import BREAK, OFF, REST, WORK

TIRED = "fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min}"
ONE = """
opsim: 1
name: one
run: {horizon: 60 min, seed: 1}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 150 s}}
stations: {s: {at: a, tasks: [make], buffer: 1}}
products: {part: {route: [s]}}
release: {kind: saturated}
workers: {w: {skills: {s: 1.0}}}
human:
  fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min, slows: 0}
  rest: {above: 0.4, until: 0.2}
"""


def rests(log):
    return log.where((log["kind"] == BREAK) & (log["cause"] == REST))


def test_a_hand_worked_rest():
    # 150 s of work each: 1 - 2^-(n/4): 0.159, 0.293, 0.405 > 0.4 after 450 s; down to 0.2 takes
    # log2(0.4053964 / 0.2) x 300 s = 305.800 s; then 0.2 -> 1 - 0.8 x 2^-(n/4): 0.327, 0.434 > 0.4 after 300 s more
    log, _ = plans.ran(ONE)
    found = rests(log)
    assert found["start_s"][:2] == pytest.approx([450.0, 450.0 + 305.800 + 300.0], abs=1e-3)
    assert found.duration_s[0] == pytest.approx(305.800, abs=1e-3)
    assert found["station"][0] == found["job"][0] == -1


def test_nobody_rests_where_nobody_is_so_tired():
    log, _ = plans.ran(ONE, ("above: 0.4", "above: 1"))
    assert not len(rests(log))


def test_a_shift_and_its_breaks_end_a_rest():
    text = ONE.replace("{w: {", "{w: {shift: day, ").replace(
        "workers:", "shifts: {day: {from: '06:00', to: '06:20', breaks: {tea: {at: '06:10', lasts: 2 min}}}}\nworkers:"
    )
    log, _ = plans.ran(text.replace("name: one\nrun: {", "name: one\nrun: {start: Mon 06:00, "))
    found = rests(log)
    assert found["start_s"][0] == 450.0 and found["end_s"][0] == 600.0
    tea = log.where((log["kind"] == BREAK) & (log["cause"] != REST))
    assert (tea["start_s"][0], tea["end_s"][0]) == (600.0, 720.0)


MEETING = """
opsim: 1
name: one
run: {start: Mon 06:00, horizon: 4 h}
layout: {places: {a: [0 m, 0 m]}}
tasks: {make: {fixed: 20 min}}
stations: {s: {at: a, tasks: [make], buffer: 2}}
products: {part: {route: [s]}}
release: {kind: saturated}
shifts: {day: {from: '06:00', to: '10:00', meetings: {short: {at: '07:02', lasts: 1 min}}}}
workers: {w: {shift: day, skills: {s: 1.0}}}
human:
  fatigue: {model: lffrm, tires_half_in: 1 h, recovers_half_in: 20 min, slows: 0}
  rest: {above: 0.45, until: 0.1}
"""


def test_a_rest_that_a_meeting_cuts_short_is_gone_on_with():
    # 1 - 2^-1 = 0.5 > 0.45 after an hour; from 0.5 to 0.1 takes log2(5) x 1200 s = 2786.3 s, the meeting in it
    log, _ = plans.ran(MEETING)
    found = rests(log)
    assert (found["start_s"][:2].tolist(), found["end_s"][0]) == ([3600.0, 3780.0], 3720.0)
    assert found["end_s"][1] == pytest.approx(3600 + 1200 * np.log2(5), abs=1e-3)


def test_a_rest_goes_on_in_overtime_where_he_is_needed():
    # 0.4054 after 450 s, 0.4054 x 2^-(30 / 300) = 0.378 > 0.35 at 480 s, the end of the shift; 0.2 at 755.8 s
    log, _ = plans.ran(
        ONE.replace("workers:", "shifts: {day: {from: '06:00', to: '06:08', overtime: {most: 40 min}}}\nworkers:"),
        ("{w: {", "{w: {shift: day, "),
        ("run: {", "run: {start: Mon 06:00, "),
        ("above: 0.4", "above: 0.35"),
    )
    found = rests(log)
    assert found["start_s"][:2].tolist() == [450.0, 480.0] and found["end_s"][1] == pytest.approx(755.8, abs=1e-3)


OVERTIME = """
opsim: 1
name: late
run: {start: Mon 06:00, horizon: 12 h, seed: SEED}
layout: {places: {x: [0 m, 0 m], y: [2 m, 0 m]}}
tasks: {t: {fixed: 14 min}, u: {fixed: 5 min}}
stations: {a: {at: x, tasks: [t]}, b: {at: y, tasks: [u]}}
products: {p: {share: 0.5, route: [a]}, q: {share: 0.5, route: [b]}}
release: {kind: poisson, every: 7 min, shift: d}
shifts: {d: {from: '06:00', to: '10:00', overtime: {most: 6 h}}}
workers: {ana: {shift: d, skills: {a: 1}}, ben: {shift: d, skills: {a: 1, b: 1}}}
human:
  fatigue: {model: lffrm, tires_half_in: 60 min, recovers_half_in: 20 min, slows: 0.0}
  rest: {above: 0.5, until: 0.1}
"""


@pytest.mark.parametrize("seed", [1, 3, 6])
def test_who_is_tired_in_overtime_and_needed_no_more_rests_at_home(seed):
    log, _ = plans.ran(OVERTIME, ("SEED", str(seed)))
    last_s = log.of(WORK)["end_s"].max()
    assert log["start_s"][log["kind"] == OFF].max() == pytest.approx(last_s) and last_s > 4 * 3600


def test_a_lower_level_is_more_rest_and_less_fatigue():
    found = []
    for above in (0.9, 0.6, 0.4, 0.3):
        plan = planned(LINE, f"human: {{{TIRED}, rest: {{above: {above}, until: 0.2}}}}")
        log = run_plan(plan)
        audit(log, plan)
        named = {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan)}
        found.append((named["rest_taken_min_per_h", "", ""], -named["fatigue_most", "", ""]))
    assert found == sorted(found) and found[0] < found[-1]


def test_nobody_rests_in_the_middle_of_his_work():
    plan = planned(LINE, f"human: {{{TIRED}, rest: {{above: 0.4, until: 0.2}}}}")
    work = run_plan(plan).of(WORK)
    assert np.all(work["progress_to"][work["end_s"] < plan.horizon_s] == 1.0)


def test_muscles_rest_too():
    text = ONE.replace("make: {fixed: 150 s}", "make: {emulator: work/stoop, load: 10 kg}").replace(
        "layout:", "libraries: {work: libraries/bench_work.npz}\nlayout:"
    )
    start = text.index("human:")
    log, _ = plans.ran(text[:start] + "human: {fatigue: {model: 3cc_r}, rest: {above: 0.3, until: 0.1}}\n")
    assert len(rests(log)) > 3


@pytest.mark.parametrize("seed", range(10))
def test_the_laws_hold_with_shifts_crews_and_rotations_and_order_decides_nothing(seed):
    blocks = (["zones", "floaters"], ["bucket_brigades"], ["rotations"], ["overtime"], ["rabbit_chases"])
    values = people_floor_with(Lots(seed), ["shifts", "breaks", *blocks[seed % len(blocks)]])
    tires = {"model": "lffrm", "tires_half_in": "5 min", "recovers_half_in": "1 min"}
    values |= {"human": {"fatigue": tires, "rest": {"above": 0.3, "until": 0.1}}}
    plan = plan_of(text_of(values))
    log = run_plan(plan)
    audit(log, plan)
    assert len(rests(log)) > 0 or tiredness(log, plan).end.max() < 0.3
    assert differ(log, run_plan(plan_of(text_of(values, Random(seed))))) == []


@pytest.mark.parametrize("seed", range(4))
def test_the_laws_hold_with_random_crews(seed):
    more = '"human": {"fatigue": {"model": "lffrm", "tires_half_in": "3 min"}, "rest": {"above": 0.3, "until": 0.1}}'
    plan = plans.plan(f"{brigade(seed)[:-1]}, {more}}}")
    log = run_plan(plan)
    audit(log, plan)
    assert len(rests(log)) > 0


def test_a_rest_is_nobodys_without_fatigue():
    plan = planned(LINE, f"human: {{{TIRED}, rest: {{above: 0.4, until: 0.2}}}}")
    log = run_plan(plan)
    without = replace(plan, human=replace(plan.human, rest=None))
    with pytest.raises(AssertionError, match="rests by need"):
        audit(log, without)
