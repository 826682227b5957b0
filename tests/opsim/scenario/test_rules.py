"""Loops of cards that let nothing in, lead nowhere, or hold only some of alternative stations.

What people may say of absence and interruption, and what is refused.

Breakdowns and maintenance as they are written, and what is said of those that cannot be.

What is wrong with the sequence of work is told at its place, with the way out; all at once.

Changes of a layout as they are written.
"""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as some
from plans import CELL, loaded, plan

from opsim.problems import ScenarioError
from opsim.scenario.fields import EXAMPLES, read_any_moved, read_moved, split_names
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: loops
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}, s3: {at: hall, tasks: [t]}}
products:
  a: {share: 0.5, route: [s1, [s2, s3], s1]}
  b: {share: 0.5, routing: {start: s2, s2: {s3: 0.5, s2: 0.5}, s3: out}}
release: {kind: poisson, every: 60 s}
"""


def read(cards, tmp_path, text=TEXT):
    return scenarios_in(f"{text}cards: {cards}\n".encode(), tmp_path / "loops.yaml")["base"]


def said(cards, tmp_path, text=TEXT):
    with pytest.raises(ScenarioError) as caught:
        read(cards, tmp_path, text)
    return "\n".join(f"{p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


@pytest.mark.parametrize("cards", [
    "{conwip: {n: 3}}",
    "{loop: {n: 1, from: s1, to: [s2, s3], products: a}}",
    "{loop: {n: 1, from: s1, to: s1}}",
    "{loop: {n: 2, from: [s2, s3]}, other: {n: 2, to: s3, products: [b]}}",
])  # fmt: skip
def test_loops_along_the_way_of_a_product_are_read(cards, tmp_path):
    read(cards, tmp_path)


@pytest.mark.parametrize(("cards", "expected"), [
    ("{k: {n: 0}}", "cards.k.n: a loop of 0 cards lets no job in | give it at least one: 'n: 1'"),
    ("{k: {n: -2}}", "cards.k.n: a loop of -2 cards lets no job in"),
    ("{k: {from: s1}}", "cards.k: 'n' is missing | add e.g. 'n: 8'"),
    ("{k: {n: 2.5}}", "cards.k.n: expected a whole number, found 2.5"),
    ("{k: {n: 2, form: s1}}", "cards.k.form: unknown key 'form' | did you mean 'from'?"),
    ("{k: {n: 2, from: s4}}", "cards.k.from: no station 's4' | known stations: s1, s2, s3"),
    ("{k: {n: 2, products: [c]}}", "cards.k.products: no product 'c'"),
    ("{k: {n: 2, to: []}}", "cards.k.to: expected a station or a list of them, found an empty list"),
    ("{k: {n: 2, from: s3, to: s2, products: b}}", "cards.k: no product of b goes from 's3' to 's2' | a loop goes"),
    ("{k: {n: 2, from: s1, products: b}}", "cards.k: no product of b comes to 's1'"),
    ("{k: {n: 2, from: s2, products: a}}", "cards.k.from: a may go to s2 or s3, and the loop has only some"),
])  # fmt: skip
def test_what_is_wrong_with_a_loop_is_told_at_its_place(cards, expected, tmp_path):
    assert expected in said(cards, tmp_path)


def test_a_saturated_source_into_an_endless_buffer_ends_where_cards_limit_it(tmp_path):
    text = TEXT.replace("release: {kind: poisson, every: 60 s}", "release: {kind: saturated, products: [b]}")
    read("{conwip: {n: 5}}", tmp_path, text)
    read("{kanban: {n: 5, from: s2, to: s3, products: b}}", tmp_path, text)
    assert "never ends" in said("{conwip: {n: 5, products: a}}", tmp_path, text)
    assert "never ends" in said("{kanban: {n: 5, from: s3}}", tmp_path, text)


STORE = """
opsim: 1
name: stock
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t]}, s2: {at: hall, tasks: [t]}}
stores: {rack: {at: hall, initial: {a: 3, b: 2}}}
products: {a: {route: [s1, rack]}, b: {route: [s1, rack]}, c: {route: [s2], parts: {s2: {a: 1, b: 1}}}}
release: {kind: poisson, every: 60 s, products: [c]}
"""


@pytest.mark.parametrize(("cards", "n"), [
    ("{k: {n: 2, from: s1, to: rack, products: a}}", 3),
    ("{k: {n: 4, from: s1, to: rack}}", 5),
    ("{k: {n: 4}}", 5),
])  # fmt: skip
def test_more_pieces_at_the_start_than_cards_for_them_are_refused(cards, n, tmp_path):
    assert f"{n} pieces lie inside the loop 'k' at the start" in said(cards, tmp_path, STORE)
    read(cards.replace("n: 2", "n: 5").replace("n: 4", "n: 5"), tmp_path, STORE)
    read("{k: {n: 1, to: s2, products: c}}", tmp_path, STORE)


SHIFTS = "shifts: {early: {from: 06:00, to: 14:00}}\n"
ANA = "ana: {skills: {unload: 1.0, repack1: 1.1}}"


def refused(*edits):
    text = CELL + SHIFTS
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as found:
        loaded(text)
    return str(found.value)


def test_absence_and_interruption_come_into_the_plan():
    text = (CELL + SHIFTS).replace(ANA, ANA.replace("{skills", "{shift: early, absence: 0.05, skills"))
    text = text.replace("between_share: 0.4}", "between_share: 0.4, interruption: hand_over}")
    p = plan(text)
    assert [worker.absence for worker in p.workers] == [0.05, 0, 0]
    assert {task.name: task.interruption for task in p.tasks}["lift"] == "hand_over"


def test_who_is_always_there_misses_no_shift():
    said = refused((ANA, ANA.replace("{skills", "{absence: 0.05, skills")))
    assert "workers.ana.absence: who has no shift is always there" in said and "name the shift" in said


def test_a_share_of_shifts_is_between_none_and_all():
    assert "workers.ana.absence" in refused((ANA, ANA.replace("{skills", "{shift: early, absence: 1.5, skills")))


def test_an_unknown_rule_is_told_with_the_known_ones():
    said = refused(("between_share: 0.4}", "between_share: 0.4, interruption: handover}"))
    assert "tasks.lift.interruption" in said and "hand_over" in said


def test_nobody_leaves_what_a_station_does_alone():
    said = refused(("{fixed: 30 s, automatic: true}", "{fixed: 30 s, automatic: true, interruption: finish}"))
    assert "tasks.press.interruption: no worker leaves what the station does alone" in said


GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")
TEAM = "repair_teams: {mechanics: {n: 2}}\n"
JAM = "{every: {dist: exponential, mean: 4 h}, repair: {fixed: 10 min}}"


def text(stops: str, more: str = TEAM) -> bytes:
    return (GOOD.replace("buffer: 4}", f"buffer: 4, {stops}}}") + more).encode()


def station(stops: str):
    return scenarios_in(text(stops), Path("line.yaml"))["base"].scenario.stations["pack"]


def failures_said(stops: str, more: str = TEAM) -> str:
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text(stops, more), Path("line.yaml"))
    return str(caught.value)


def test_a_breakdown_is_by_the_clock_and_work_goes_on_unless_it_says_otherwise():
    jam = station(f"breakdowns: {{jam: {JAM}}}").breakdowns["jam"]
    assert (jam.by, jam.job, jam.team, jam.every.mean_s, jam.repair.fixed_s) == ("clock", "resume", None, 14400, 600)


@pytest.mark.parametrize("every", ["500", "{dist: geometric, mean: 99.5}", "{dist: uniform, low: 400, high: 500}"])
def test_cycles_are_numbers_without_a_unit(every):
    stops = f"breakdowns: {{jam: {{every: {every}, by: cycles, repair: {{fixed: 1 min}}}}}}"
    assert station(stops).breakdowns["jam"].by == "cycles"
    assert "by: busy needs a time, found a number of cycles" in failures_said(stops.replace("cycles", "busy"))


def test_maintenance_is_due_after_its_period_unless_it_says_when():
    oiling = station("maintenance: {oiling: {every: 2 h, lasts: 20 min, team: mechanics}}").maintenance["oiling"]
    assert (oiling.every_s, oiling.first_s, oiling.lasts_s, oiling.when) == (7200, None, 1200, "after_job")


@pytest.mark.parametrize(("stops", "place", "found", "remedy"), [
    ("breakdowns: {jam: {every: 4 h, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every", "'4 h' on average or exactly?", "{dist: exponential, mean: ...}"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: 10 min}}",
     "stations.pack.breakdowns.jam.repair", "'10 min' on average or exactly?", "{fixed: ...}"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, by: cycles, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every", "by: cycles counts operations, found a time", "such as 500"),
    ("breakdowns: {jam: {every: {dist: uniform, low: 9, high: 8}, by: cycles, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.every.low", "low (9) must be at most high (8)", ""),
    ("breakdowns: {jam: {evry: {fixed: 4 h}, repair: {fixed: 1 min}}}",
     "stations.pack.breakdowns.jam.evry", "unknown key 'evry'", "did you mean 'every'?"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {fixed: 1 min, repeat: 2}}}",
     "stations.pack.breakdowns.jam.repair.repeat", "'repeat' means nothing here", "remove it"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {emulator: moves/lift}}}",
     "stations.pack.breakdowns.jam.repair", "a time without a body is wanted here", "take fixed, recorded or dist"),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {recorded: no.csv}}}",
     "stations.pack.breakdowns.jam.repair.recorded", "no file 'no.csv' in the scenario's folder", ""),
    ("breakdowns: {jam: {every: {fixed: 4 h}, repair: {fixed: 1 min}, team: mechanix}}",
     "stations.pack.breakdowns.jam.team", "no repair team 'mechanix'", "did you mean 'mechanics'?"),
    ("maintenance: {oiling: {every: 1 h, lasts: 1 h}}",
     "stations.pack.maintenance.oiling.lasts", "lasts 3600 s and comes every 3600 s", "make it shorter, or rarer"),
    ("maintenance: {oiling: {every: 20 h, lasts: 8 h}}",
     "stations.pack.maintenance.oiling.lasts", "lasts 28800 s, and the whole run only 28800 s", "make it shorter"),
    ("maintenance: {oiling: {every: 2 h, lasts: 1 h}, cleaning: {every: 3 h, lasts: {fixed: 90 min}}}",
     "stations.pack.maintenance", "these together take 100% of the time", "make them shorter, or rarer"),
    (f"maintenance: {{jam: {{every: 2 h, lasts: 1 min}}}}, breakdowns: {{jam: {JAM}}}",
     "stations.pack.maintenance.jam", "a breakdown of this station is called 'jam' as well", "change one"),
])  # fmt: skip
def test_a_stop_that_cannot_be_is_refused_with_its_place_and_a_remedy(stops, place, found, remedy):
    answer = failures_said(stops)
    assert f": {place}: {found}" in answer
    assert remedy in answer
    assert answer.endswith("\n1 problem in line.yaml")


def test_without_any_team_the_remedy_is_the_section():
    stops = "maintenance: {oiling: {every: 2 h, lasts: 1 min, team: mechanics}}"
    assert "add a section 'repair_teams: {mechanics: {n: 1}}'" in failures_said(stops, "")


def test_a_team_of_nobody_is_refused():
    assert "repair_teams.mechanics.n: must be at least 1, found 0" in failures_said(
        "breakdowns: {}", TEAM.replace("2", "0")
    )


SEQUENCE_TEXT = """
opsim: 1
name: shop
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 10 s, automatic: true}, change: {fixed: 60 s}, crew: {fixed: 60 s, team: 2}}
stations: {saw: {at: hall, tasks: [cut]STATION}}
products:
  a: {share: 0.5, route: [saw], family: big}
  b: {share: 0.5, route: [saw]}
release: {kind: poisson, every: 60 s}
workers: {eve: {skills: {saw: 1}}}
"""


def sequence_read(station, more, folder):
    text = SEQUENCE_TEXT.replace("STATION", station and f", {station}") + more
    return scenarios_in(text.encode(), folder / "shop.yaml")["base"].scenario


@pytest.mark.parametrize("station", [
    "dispatch: downstream_first, preempt: resume, buffer_after: 3, blocking: before",
    "setup: {otherwise: 10 min}",
    "setup: {times: {a: {b: change}, b: {a: 1 min 30 s}}, first: b, attended: false}",
    "setup: {times: {big: {b: 5 min}, b: {big: 0 s}}, by: family}",
])  # fmt: skip
def test_what_is_right_is_read(station, tmp_path):
    sequence_read(station, "flow: {dispatch: spt, routing: in_order, blocking: after}\n", tmp_path)


WRONG = {
    ("dispatch: spd", ""): ("stations.saw.dispatch: no rule 'spd'", "did you mean 'spt'?"),
    ("", "flow: {dispatch: fastest}"): ("flow.dispatch: no rule 'fastest'", "known rules: critical_ratio"),
    ("", "flow: {routing: in_oder}"): ("flow.routing: no rule 'in_oder'", "did you mean 'in_order'?"),
    ("", "flow: {blocking: both}"): ("flow.blocking", "after"),
    ("", "flow: {dispatc: spt}"): ("flow.dispatc", "did you mean 'dispatch'?"),
    ("dispatch: edd", ""): ("stations.saw.dispatch: edd goes by due dates, and no job has one", "such as 'due: 4 h'"),
    ("preempt: resume, buffer: 0", ""): (
        "stations.saw.preempt: nothing is ever pre-empted",
        "give the station a buffer",
    ),
    ("preempt: abort", ""): ("stations.saw.preempt", "resume"),
    ("preempt: resume, batch: {size: 4}", ""): ("stations.saw.preempt: the jobs of a batch", "remove 'preempt'"),
    ("blocking: before, batch: {size: 4}", ""): ("stations.saw.batch: the jobs of a batch go on", "'blocking: after'"),
    ("batch: {size: 4}", "flow: {blocking: before}"): ("stations.saw.batch: the jobs of a batch go on", ""),
    ("buffer_after: -1", ""): ("stations.saw.buffer_after", "-1"),
    ("setup: {}", ""): ("stations.saw.setup: nothing says how long a set-up takes", "add e.g. 'otherwise: 10 min'"),
    ("setup: {otherwise: 5}", ""): ("stations.saw.setup.otherwise", "5 s"),
    ("setup: {otherwise: -5 s}", ""): ("stations.saw.setup.otherwise: must be from 0 s", ""),
    ("setup: {otherwise: 5 mins}", ""): ("stations.saw.setup.otherwise", "min"),
    ("setup: {otherwise: chnge}", ""): ("stations.saw.setup.otherwise: no task 'chnge'", "did you mean 'change'?"),
    ("setup: {otherwise: crew}", ""): ("stations.saw.setup.otherwise: 'crew' has 'team'", ""),
    ("setup: {times: {a: {c: 5 s}}, otherwise: 5 s}", ""): ("stations.saw.setup.times.a.c: no product 'c'", "known"),
    ("setup: {times: {a: {b: 5 s}}, by: family, otherwise: 5 s}", ""): (
        "stations.saw.setup.times.a: no family 'a'",
        "",
    ),
    ("setup: {first: x, otherwise: 5 s}", ""): ("stations.saw.setup.first: no product 'x'", ""),
    ("setup: {times: {a: {b: 5 s}}}", ""): (
        "stations.saw.setup: nothing says how long the set-up from 'b' to 'a'",
        "add it",
    ),
}


@pytest.mark.parametrize("wrong", WRONG, ids=" ".join)
def test_what_is_wrong_is_told_with_the_way_out(wrong, tmp_path):
    station, more = wrong
    with pytest.raises(ScenarioError) as caught:
        sequence_read(station, more + "\n", tmp_path)
    said = "\n".join(f"{one.path}: {one.message} | {one.hint}" for one in caught.value.problems)
    message, hint = WRONG[wrong]
    assert message in said and hint in said
    assert len(caught.value.problems) == 1


def test_a_setup_that_nobody_can_do_is_told(tmp_path):
    with pytest.raises(ScenarioError, match="the set-up needs a worker, and no worker has the skill 'saw'"):
        scenarios_in(
            SEQUENCE_TEXT.replace("STATION", ", setup: {otherwise: 5 s}").replace("workers:", "#").encode(),
            tmp_path / "shop.yaml",
        )


def test_all_mistakes_are_told_at_once(tmp_path):
    with pytest.raises(ScenarioError) as caught:
        sequence_read(
            "dispatch: spd, preempt: resume, buffer: 0, setup: {first: x, otherwise: y}",
            "flow: {routing: z}\n",
            tmp_path,
        )
    assert len(caught.value.problems) == 5


names = some.from_regex(r"[a-z][a-z0-9_]{0,8}", fullmatch=True)


@pytest.mark.parametrize("kind", EXAMPLES)
def test_every_example_can_be_read_and_is_written_the_same(kind):
    moved = read_moved(kind, EXAMPLES[kind])
    assert str(moved) == f"{kind} {EXAMPLES[kind]}" and read_any_moved(str(moved)) == moved


@given(names, names, names)
def test_what_is_read_is_what_was_written(a, b, c):
    assert read_moved("add", f" {a} = like {b}  at {c} ").what == (a, b, c)
    assert read_moved("place", f"{a}={c}").what == (a, c)
    if a != b:
        assert read_moved("swap", f"{a} , {b}").what == (a, b)


@given(some.text(max_size=30))
def test_any_text_is_read_or_refused_in_words(text):
    for kind in EXAMPLES:
        try:
            read_moved(kind, text)
        except ValueError as error:
            assert kind in str(error)


@pytest.mark.parametrize(
    "text, words",
    [
        ("swap saw", "cannot be read; such as swap 'saw,drill'"),
        ("swap saw,saw", "cannot change places with itself"),
        ("swop saw,drill", "did you mean 'swap'?"),
        ("move bench=6, 1 m", "6 has no unit"),
        ("", "expected a change of the layout"),
    ],
)
def test_what_cannot_be_read_is_said_with_an_example(text, words):
    with pytest.raises(ValueError) as error:
        read_any_moved(text)
    assert words in str(error.value)


def test_names_with_commas_between_them():
    assert split_names(" a, b ,,c") == ["a", "b", "c"]
