"""What the sheet says of scoring, of hands that nobody described, and of human effects.

What figures of lifting, holding, energy and rest say that they take as given.

Figures of posture on their way through a study.
"""

import numpy as np
import plans
import pytest
from plans import loaded

from opsim.ergonomics.options import NOT_SEEN, RULES
from opsim.plan import compile_plan
from opsim.results import Result
from opsim.study import Precision, run_scenario
from opsim.study.assumptions import assumptions_of
from opsim.study.compare import NotComparable, compare
from opsim.subjects.exposure.assumptions import ergonomics
from opsim.subjects.human.assumptions import human

CELL = """
opsim: 1
name: sheet
run: {horizon: 1 h}
libraries: {work: libraries/bench_work.npz}
layout: {places: {a: [0 m, 0 m]}}
shifts: {early: {from: '06:00', to: '14:00'}}
tasks:
  make: {emulator: work/fasten, load: 2 kg, loaded: {from: 0.2, to: 0.8}, handling: {grip: fair, force: static}}
  wait: {fixed: 9 s}
stations: {s1: {at: a, tasks: [make, wait]}}
products: {part: {route: [s1]}}
release: {kind: poisson, every: 50 s}
workers: {ana: {shift: early, skills: {s1: 1}, experience: {make: 40}}}
outputs: [rula_mean]
"""
EFFECTS = ("outputs:", "human: {learning: {model: wright, rate: 0.9}, fatigue: {model: lffrm}, absence: 0.1}\noutputs:")


def said(part, *edits):
    text = CELL
    for old, new in edits:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    loaded = plans.loaded(text)
    return [f"{topic}: {words}" for topic, words in part(loaded, plans.compile_plan(loaded))]


def test_nothing_is_said_of_scores_that_nobody_asks_for():
    assert said(ergonomics, ("rula_mean", "walked_m")) == []


def test_the_ways_taken_where_methods_part_are_named():
    usual = " ".join(said(ergonomics))
    assert "12 postures a second; upper arms are measured against the trunk" in usual
    assert "twisted from 10, bent sideways from 10, arm abducted from 30" in usual
    options = (
        "ergonomics: {arm_reference: gravity, rula: {table_a: worksheet2000, force: worksheet}, waiting: upright, "
    )
    options += "owas: {disputed: ['3373']}, thresholds: {twist: 15 deg, spread: true}}\noutputs:"
    other = " ".join(said(ergonomics, ("outputs:", options)))
    for words in (
        "gravity: hanging",
        "worksheet of 2000",
        "always 3)",
        "category for 3373",
        "upright with",
        "twisted from 15",
    ):
        assert words in other, words
    assert "over all from 5 to 20" in other


def test_what_nobody_said_is_listed_by_task_with_the_score_that_it_leaves_open():
    lines = said(ergonomics)
    assert "loads: in the hands, as the scenario says: make 2 kg between two moments of each performance" in lines
    assert "not said: make: forearm: RULA is an interval over the twist of the forearm" in lines
    assert not any("grip" in line or line.startswith("not said: make: load") for line in lines)
    bare = said(ergonomics, (", load: 2 kg, loaded: {from: 0.2, to: 0.8}, handling: {grip: fair, force: static}", ""))
    assert [line.split(":")[2].strip() for line in bare if line.startswith("not said")] == [
        *("load", "grip", "force", "forearm", "arms supported", "sitting", "legs", "rapid")
    ]


def test_what_no_skeleton_shows_is_listed_in_full():
    assert [line for line in said(ergonomics) if line.startswith("not seen")] == [
        f"not seen: {one}" for one in NOT_SEEN
    ]
    assert [line for line in said(ergonomics) if line.startswith("by rule")] == [f"by rule: {one}" for one in RULES]


def test_posture_off_is_said():
    off = said(ergonomics, ("horizon: 1 h", "horizon: 1 h, posture: off"), ("rula_mean", "walked_m"))
    assert off == [
        "postures: posture: off: nobody looks at postures, and there is no figure of them; times are as ever"
    ]


def test_each_effect_has_its_source_and_says_which_parameters_nobody_gave():
    learning, fatigue, shift, still, *_ = said(human, EFFECTS)
    assert learning.startswith("human effects: learning, wright (rate 0.9, measured_at 1 by default): each doubling")
    assert "Wright, T. P. (1936)" in learning
    assert "fatigue, lffrm (tires_half_in 4 h by default" in fatigue and "Jaber" in fatigue
    assert "is an assumption" in fatigue
    assert "an extrapolation" in shift
    assert still == "human effects: wait: the time alone follows the shift of pace; there is no body that could"


def test_experience_and_absence_of_everybody_are_said():
    lines = said(human, EFFECTS)
    assert "absence: ana: 0.1 of their shifts, as the scenario says of everybody" in lines
    assert any(
        line.startswith("experience: repetitions behind them at the start: ana make 40; whoever") for line in lines
    )


def test_by_time_alone_postures_stay():
    (line,) = said(human, ("outputs:", "human: {acts_on: time, fatigue: {model: lffrm}}\noutputs:"))[1:2]
    assert "effects change times alone" in line


@pytest.mark.parametrize("edits", [(), (EFFECTS,)])
def test_nobody_is_called_fresh_who_tires(edits):
    told = " ".join(said(assumptions_of, *edits))
    assert ("no fatigue" in told) is (not edits) and ("no learning" in told) is (not edits)


def test_nothing_is_said_where_no_effect_is_on():
    assert said(human) == []


STRAIN_CELL = """
opsim: 1
name: cell
run: {horizon: 600 s}
layout: {places: {a: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, load: 5 kg}}
stations: {s: {at: a, tasks: [t], buffer: 1}}
products: {p: {route: [s]}}
release: {kind: saturated}
workers: {ana: {mass: 60 kg, sex: f, skills: {s: 1.0}}, ben: {skills: {s: 1.0}}}
outputs: [OUT]
"""
"""OUT: what is asked for."""


def strain_said(text):
    made = loaded(text)
    return assumptions_of(made, compile_plan(made))


@pytest.mark.parametrize(
    ("asked", "topics"),
    [
        ("throughput_per_h", set()),
        ("lifting_index", {"lifting"}),
        ("iso_11226_min_per_h", {"limits"}),
        ("energy_kcal_per_min", {"energy"}),
        ("rest_allowance_share", {"energy", "rest"}),
    ],
)
def test_each_figure_says_its_own(asked, topics):
    found = {topic for topic, _ in strain_said(STRAIN_CELL.replace("OUT", asked))}
    assert found & {"lifting", "limits", "energy", "rest"} == topics


@pytest.mark.parametrize(
    ("asked", "topic", "words"),
    [
        ("iso_11226_min_per_h", "limits", "5 degrees backward are upright"),
        ("iso_11226_min_per_h", "limits", "each judged at its mean angle"),
        ("iso_11226_min_per_h", "limits", "each zone at the edge at which it begins"),
        ("rest_allowance_share", "rest", "of the time at work (there, and in no break)"),
    ],
)
def test_what_was_decided_is_said(asked, topic, words):
    assert any(words in line for one, line in strain_said(STRAIN_CELL.replace("OUT", asked)) if one == topic)


def test_what_is_repeated_is_said_where_scores_are_asked_for():
    text = STRAIN_CELL.replace("OUT", "rula_mean").replace("fixed: 10 s", "emulator: bench/stoop")
    lines = strain_said(text + "libraries: {bench: libraries/bench_work.npz}\n")
    assert any(
        "a cycle of 15 s or less (4 beginnings within 45 s)" in line for topic, line in lines if topic == "scores"
    )


def test_who_told_nothing_of_himself_is_named():
    lines = [
        line for topic, line in strain_said(STRAIN_CELL.replace("OUT", "energy_kcal_per_min")) if topic == "energy"
    ]
    assert any("75 kg are taken for ben" in line for line in lines)
    assert any("range, for ben" in line for line in lines)
    assert not any("ana" in line for line in lines)


def test_nobody_looks_nothing_is_assumed():
    off = STRAIN_CELL.replace("600 s}", "600 s, posture: off}").replace("OUT", "throughput_per_h")
    assert not {"lifting", "limits", "energy", "rest"} & {topic for topic, _ in strain_said(off)}


@pytest.mark.parametrize(
    ("asked", "topic", "edit", "words"),
    [
        ("lifting_index", "lifting", (), ": no shifts: lifting lasts at least as long as in the run, and at most 8 h"),
        ("lifting_index", "lifting", (), "the duration of lifting is that of the shift"),
        ("lifting_index", "lifting", (), "no bound there"),
        ("lifting_index", "lifting", ("5 kg}", "5 kg, handling: {sitting: true}}"), "t: done sitting, for which"),
        ("lifting_index", "lifting", ("5 kg}", "5 kg, team: 2}"), "t: load is what each member of the team"),
        ("energy_kcal_per_min", "energy", ("5 kg}", "5 kg, team: 2}"), "t: load is what each member of the team"),
        ("energy_kcal_per_min", "energy", (), "each way down and up without a load (hands below 81 cm"),
        ("energy_kcal_per_min", "energy", (), "who walks has empty hands, but for the job of a product that is"),
        ("energy_kcal_per_min", "energy", ("[s]}", "[s], carried: true}"), "; p: no mass told, so nothing"),
    ],
)
def test_what_loads_and_hands_are_taken_for_is_said(asked, topic, edit, words):
    text = STRAIN_CELL.replace("OUT", asked)
    found = strain_said(text.replace(*edit) if edit else text)
    assert any(words in line for one, line in found if one == topic)


POSTURE_CELL = """
opsim: 1
name: bending
run: {horizon: 30 min, warm_up: 5 min, replications: 3, seed: 2}
libraries: {moves: libraries/public_movements.npz}
layout: {places: {a: [0 m, 0 m]}}
tasks:
  squat: {emulator: moves/deep_squat}
  label: {fixed: 5 s}
  stow:  {emulator: moves/shoulder_scaption}
stations: {s1: {at: a, tasks: [squat, label, stow], buffer: 1}}
products: {p: {route: [s1]}}
release: {kind: poisson, every: 20 s}
workers: {ana: {skills: {s1: 1.0}}, ben: {skills: {s1: 0.9}}}
overrides: {more: {release.every: 10 s}, twice: {tasks.squat.repeat: 2}}
scenarios: {base: [], same: [], busy: [more], deep: [twice]}
outputs: OUTPUTS
"""
BEYOND = "trunk_beyond_20_min_per_h"


def ran(folder, outputs, variant="base", **how):
    return run_scenario(
        loaded(POSTURE_CELL.replace("OUTPUTS", f"[{outputs}]"), variant), folder=folder, processes=1, **how
    )


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    return {name: ran(folder / name, f"walked_m, {BEYOND}", name) for name in ("base", "same", "busy", "deep")}


def rows(result, kpi):
    return {row["subject"]: row for row in result.summary["kpis"] if row["kpi"] == kpi}


def test_a_figure_of_posture_has_a_mean_and_an_interval_like_any_other(results):
    found = rows(results["base"], BEYOND)
    assert set(found) == {"", "ana", "ben"} and found[""]["headline"] and found[""]["n"] == 3
    assert 0 < found[""]["low"] < found[""]["mean"] < found[""]["high"]
    assert found[""]["mean"] == pytest.approx((found["ana"]["mean"] + found["ben"]["mean"]) / 2)


def test_how_much_was_measured_stands_in_front_too(results):
    found = rows(results["base"], "posture_measured_share")
    assert found[""]["headline"] and 0.4 < found[""]["mean"] < 0.6
    assert not rows(results["base"], "trunk_flexion_p95_deg")[""]["headline"]


def test_variants_are_compared_pair_by_pair(results):
    verdicts = {d.variant: d for d in compare(results, kpis=[BEYOND]).differences if not d.key[1]}
    assert verdicts["same"].identical
    assert verdicts["deep"].verdict == "higher" and verdicts["deep"].interval.low > 0
    assert verdicts["deep"].mean == pytest.approx(2 * verdicts["deep"].base, rel=0.2)
    assert verdicts["busy"].interval.n == 3


def test_the_assumption_sheet_names_what_was_not_measured(results):
    said = " ".join(row["says"] for row in results["base"].summary["assumptions"] if row["topic"] == "postures")
    assert "label: no posture is known" in said and "squat" not in said


def test_rows_that_are_there_are_measured_when_it_is_asked_for(tmp_path):
    before = ran(tmp_path, "walked_m")
    written = {path: path.stat().st_mtime_ns for path in before.events_files}
    assert not rows(before, BEYOND)
    after = ran(tmp_path, BEYOND)
    assert rows(after, BEYOND)[""]["n"] == 3
    assert {path: path.stat().st_mtime_ns for path in after.events_files} == written


def test_a_figure_that_was_not_asked_for_is_not_there_and_compare_says_how_to_get_it(tmp_path):
    without = {name: ran(tmp_path / name, "walked_m", name, replications=1) for name in ("base", "busy")}
    with pytest.raises(NotComparable, match="it is made where the scenario's 'outputs' list it"):
        compare(without, kpis=[BEYOND])


def test_a_precision_is_enough_to_ask_for_it(tmp_path):
    result = ran(tmp_path, "walked_m", replications=10, precision=[Precision(BEYOND, "", "", 0.5)])
    assert rows(result, BEYOND)[""]["n"] == 10 and result.summary["precision"][0]["found"] > 0


@pytest.mark.slow
def test_one_and_two_processes_measure_the_same(results, tmp_path):
    other = run_scenario(loaded(POSTURE_CELL.replace("OUTPUTS", f"[walked_m, {BEYOND}]")), folder=tmp_path, processes=2)
    here, there = (Result.load(result.folder).kpis() for result in (results["base"], other))
    assert np.array_equal(
        [list(row.values()) for row in here.values()], [list(row.values()) for row in there.values()], equal_nan=True
    )
