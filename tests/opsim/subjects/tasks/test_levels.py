"""Tasks whose height changes with the product or the layer: who goes to which level, with which luck."""

from collections import Counter

import numpy as np
import pytest
from choices import Lots
from engine_evidence import floors
from engine_evidence.more_times import heights
from made.floors import text_of
from plans import answer, loaded, plan
from twins import of_both

from opsim.ergonomics.redraw import performance_again
from opsim.history import drawn_s
from opsim.laws.audit import BrokenLog, audit
from opsim.log import WORK, EventLog
from opsim.plan.loads.work_times import ANYBODY, WorkTimes
from opsim.report.sections.variability import spreads
from opsim.study.assumptions import assumptions_of
from opsim.subjects.tasks.plan import for_product, performed_ranks

PALLET = """
opsim: 1
name: pallet
run: {start: Mon 00:00, horizon: 20 min, seed: 5}
libraries: {handling: libraries/handling.npz}
layout:
  places:
    pallet: {at: [0 m, 0 m], levels: {top: 1.2 m, middle: 0.75 m, bottom: 0.3 m}}
    rack: {at: [3 m, 0 m], levels: {low: 0.3 m, hip: 0.95 m}}
tasks:
  pick: {emulator: handling/shelf, hands: {grasp: {layers: [pallet.top, pallet.middle, pallet.bottom], pieces_each: 4}}}
  put:  {emulator: handling/shelf, hands: {grasp: {carton: rack.low, case: rack.hip}}}
stations: {a: {at: pallet, tasks: [pick], servers: 2, buffer: 2}, b: {at: rack, tasks: [put], servers: 2, buffer: 2}}
products: {carton: {share: 0.6, route: [a, b]}, case: {share: 0.4, route: [a, b]}}
release: {kind: saturated}
workers: {ana: {height: 1.6 m, skills: {a: 1.0, b: 1.0}}, ben: {like: ana, height: 1.9 m}}
allocation: {rule: oldest_job}
"""
LEVELS = ("pick [pallet.top]", "pick [pallet.middle]", "pick [pallet.bottom]")


def begun(log, made, names):
    """Rows of work at some tasks, one for each performance, as they were begun."""
    ranks = [rank for rank, task in enumerate(made.tasks) if task.name in names]
    rows = np.flatnonzero((log["kind"] == WORK) & np.isin(log["task"], ranks))
    rows = rows[np.lexsort((log["start_s"][rows], log["performance_id"][rows]))]
    return rows[np.unique(log["performance_id"][rows], return_index=True)[1]]


@pytest.fixture(scope="module")
def pallet():
    made = plan(PALLET)
    log = of_both(made)
    audit(log, made)
    return log, made


def test_a_pallet_empties_layer_by_layer_and_a_full_one_follows(pallet):
    log, made = pallet
    layers = [made.tasks[task].name for task in log["task"][begun(log, made, LEVELS)]]
    assert len(layers) > 100
    assert layers == [LEVELS[n // 4 % 3] for n in range(len(layers))]


def test_each_product_has_its_level(pallet):
    log, made = pallet
    rows = begun(log, made, ("put [rack.low]", "put [rack.hip]"))
    found = Counter((made.products[log["product"][row]].name, made.tasks[log["task"][row]].name) for row in rows)
    assert found.keys() == {("carton", "put [rack.low]"), ("case", "put [rack.hip]")} and min(found.values()) > 20


def test_item_k_of_a_worker_is_one_luck_at_every_level(pallet):
    """The k-th of all, whatever its level, takes what that level makes of item k: as when all were at that one."""
    log, made = pallet
    for worker in range(2):
        rows = begun(log, made, LEVELS)
        rows = rows[log["worker"][rows] == worker]
        assert log["k"][rows].tolist() == list(range(rows.size))
        for name in LEVELS:
            one = plan(
                PALLET.replace("{layers: [pallet.top, pallet.middle, pallet.bottom], pieces_each: 4}", name[6:-1])
            )
            rank, there = ([task.name for task in of.tasks].index(key) for of, key in ((made, name), (one, "pick")))
            k = log["k"][rows[log["task"][rows] == rank]]
            assert k.size > 10
            assert np.array_equal(drawn_s(made, 0, worker, rank, k), drawn_s(one, 0, worker, there, k))


def test_the_body_behind_a_row_is_at_the_level_of_the_row(pallet):
    log, made = pallet
    for name, height_m in zip(LEVELS, (1.2, 0.75, 0.3)):
        one = performance_again(log, made, int(begun(log, made, [name])[3]))
        assert one.duration_s == pytest.approx(log.duration_s[begun(log, made, [name])[3]], abs=1e-5)
        joints_m = one.drawn.block.positions_m(one.drawn.block.mark_s[:, [0]])[one.drawn.row, 0]
        wrists = [one.drawn.block.skeleton.names.index(f"{side}_wrist") for side in ("left", "right")]
        assert joints_m[wrists, 2].mean() == pytest.approx(height_m, abs=0.01)


def test_mean_times_are_those_of_the_product_and_of_the_layers_on_average(pallet):
    _, made = pallet
    low, hip = (next(task for task in made.tasks if task.name == f"put [rack.{level}]") for level in ("low", "hip"))
    assert [for_product(made.tasks, [t.name for t in made.tasks].index("put"), p).name for p in (0, 1)] == [
        low.name,
        hip.name,
    ]
    times = WorkTimes(made)
    at_low, at_hip, of_layers = (times.by_hand_s(ANYBODY, *one) for one in ((1, 0), (1, 1), (0, 0)))
    assert at_low == low.mean_s() > 1.1 * hip.mean_s() == pytest.approx(1.1 * at_hip)
    layers = [next(task for task in made.tasks if task.name == name).mean_s() for name in LEVELS]
    assert of_layers == pytest.approx(np.mean(layers))


def test_a_log_with_a_layer_out_of_turn_or_a_product_at_another_level_is_found(pallet):
    log, made = pallet
    names = [task.name for task in made.tasks]
    for rows, other in (
        (begun(log, made, LEVELS[:1])[4:5], LEVELS[1]),
        (begun(log, made, ["put [rack.low]"])[:1], "put [rack.hip]"),
        (begun(log, made, ["put [rack.low]"])[:1], "put"),
    ):
        task = log["task"].copy()
        task[rows] = names.index(other)
        wrong = EventLog(log.replication, log.horizon_s, log.columns | {"task": task}, log.names)
        with pytest.raises(BrokenLog, match="is next"):
            audit(wrong, made)


def test_what_is_begun_anew_or_by_another_is_at_its_own_level():
    """Breaks every two minutes: work is lost, or handed over, and takes no other piece from the layer."""
    shifts = (
        "shifts: {s: {from: '00:00', to: '00:20', at_break: RULE, breaks: {"
        + ", ".join(f"b{n}: {{at: '00:{n:02}', lasts: 20 s}}" for n in range(1, 19))
        + "}}}\n"
    )
    for rule in ("restart", "resume_any", "resume"):
        text = PALLET.replace("workers: {ana: {", shifts.replace("RULE", rule) + "workers: {ana: {shift: s, ")
        made = plan(text)
        log = of_both(made)
        audit(log, made)
        rows = begun(log, made, LEVELS)
        assert np.any(log["progress_to"][log["task"] >= 0] < 1.0)
        assert Counter(log["task"][rows].tolist()).keys() == set(performed_ranks(made.tasks, 0))


FLOORS = (39, 60, 105, 117, 126, 228, 393)
LONG = (6, 24, 150, 183, 249)


@pytest.mark.parametrize("number", [*FLOORS, *(pytest.param(number, marks=pytest.mark.slow) for number in LONG)])
def test_random_floors_with_heights_that_change_are_alike_in_both_engines(number):
    values = floors._drawn(number, floors.attempt_of(number))
    heights(Lots(number), values)
    made = floors.plan_of(text_of(values))
    assert any(task.levels is not None for task in made.tasks)
    log = of_both(made, floors.replication_of(number))
    audit(log, made)
    assert any(task.of is not None and np.any(log["task"] == rank) for rank, task in enumerate(made.tasks))


HANDS = "grasp: {carton: rack.low, case: rack.hip}"
LAYERS = "{layers: [pallet.top, pallet.middle, pallet.bottom], pieces_each: 4}"
FORGETS = "human: {learning: {model: wright}, forgetting: {model: lfcm}}\nallocation:"
PUT, PICK = "tasks.put.hands.grasp", "tasks.pick.hands.grasp"
WRONG = [
    ("level", [("carton: rack.low", "carton: rack.lwo")], [PUT + ".carton: no height 'lwo'", "'low'?"]),
    ("level of a layer", [("pallet.middle,", "pallet.midle,")], [PICK + ".layers[1]: no height 'midle'", "'middle'?"]),
    ("place", [("pallet.bottom]", "palet.bottom]")], [PICK + ".layers[2]: no place 'palet'", "'pallet'?"]),
    ("product", [(HANDS, "grasp: {carton: rack.low, cese: rack.hip}")], [PUT + ".cese: no product 'cese'", "'case'?"]),
    ("left out", [(", case: rack.hip", "")], [PUT + ": nothing says where hands go for 'case'", "'case: rack.low'"]),
    ("no count", [(", pieces_each: 4", "")], [PICK + ": 'pieces_each' is missing", "pieces_each: 8"]),
    ("count", [("pieces_each: 4", "pieces_each: 0")], [PICK + ".pieces_each: must be at least 1, found 0"]),
    ("half", [("pieces_each: 4", "pieces_each: 1.5")], [PICK + ".pieces_each: expected a whole number"]),
    ("no layers", [("[pallet.top, pallet.middle, pallet.bottom]", "[]")], [PICK + ".layers: expected at least one"]),
    ("key", [("layers:", "layer:")], [PICK + ".layer: unknown key 'layer'", "'layers'?"]),
    ("a list", [(LAYERS, "[pallet.top]")], [PICK + ": expected a height, found", "layers: [pallet.top"]),
    ("nothing", [(HANDS, "grasp: {}")], [PUT + ": expected a height, found {}", "carton: rack.low"]),
    ("no unit", [(HANDS, "grasp: {carton: 1, case: rack.hip}")], [PUT + ".carton: 1 has no unit"]),
    ("far", [("middle: 0.75 m", "middle: 2.9 m")], ["layout.places.pallet.levels.middle: tasks.pick: ", "far outside"]),
    ("team", [("pick: {", "pick: {team: 2, ")], ["tasks.pick.hands: heights that change go with one worker", "'team'"]),
    ("forgets", [("allocation:", FORGETS)], ["human.forgetting: the hands of 'pick'", "the hands of 'put'"]),
    ("set-up", [("b: {at", "b: {setup: {times: {carton: {case: put}}}, at")], ["b.setup: the hands of 'put'"]),
    ("at once", [(HANDS, "grasp: {cartn: rack.lwo}"), ("4}", "0}")], ["'cartn'", "'lwo'", "at least 1", "for 'case'"]),
]  # fmt: skip


@pytest.mark.parametrize(("edits", "said"), [row[1:] for row in WRONG], ids=[row[0] for row in WRONG])
def test_what_is_wrong_is_said_with_its_place_and_what_would_be_right(edits, said):
    found = answer(PALLET, *edits)
    assert all(words in found for words in said), found


def test_a_product_that_never_comes_need_not_be_said():
    assert (
        answer(
            PALLET, ("case: {share: 0.4, route: [a, b]}", "case: {share: 0.4, route: [a]}"), (", case: rack.hip", "")
        )
        == "good"
    )


def test_the_assumption_sheet_names_every_level():
    read = loaded(PALLET)
    said = " ".join(words for _, words in assumptions_of(read, plan(PALLET)))
    assert all(f"{name}: the middle of both hands" in said for name in (*LEVELS, "put [rack.low]", "put [rack.hip]"))


def test_experience_in_a_task_holds_at_all_its_levels():
    text = PALLET.replace("ben: {like", "ben: {experience: {pick: 300}, like") + "human: {learning: {model: wright}}\n"
    made = plan(text)
    log = of_both(made)
    audit(log, made)
    at = {task.name: made.human.experience[1][rank] for rank, task in enumerate(made.tasks)}
    assert {at[name] for name in LEVELS} == {300.0} and at["put [rack.low]"] == 0.0


def test_the_chart_of_time_spread_has_the_levels_and_not_the_task_that_they_stand_for():
    told = [one.task for one in spreads(plan(PALLET), "full")]
    assert sorted(told) == sorted([*LEVELS, "put [rack.low]", "put [rack.hip]"])
