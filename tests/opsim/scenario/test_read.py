import pickle
import time
from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from opsim import libraries
from opsim.plan import compile_plan
from opsim.plan.loads import station_loads
from opsim.plan.warnings import risks_of
from opsim.problems import ScenarioError
from opsim.scenario import Scenario, read_scenarios
from opsim.scenario.read import scenarios_in
from opsim.scenario.tree import child
from opsim.scenario.yaml import read_tree, scalar
from opsim.tasks import Erlang, Lognormal, Recorded, task_model, time_model

HERE = Path(__file__).parent
GOOD = (HERE / "good.yaml").read_text(encoding="utf-8")
EVERYTHING = (HERE / "everything.yaml").read_text(encoding="utf-8")
TASKS = ("deep_squat", "side_lunge", "shoulder_scaption")


@pytest.fixture
def moves(monkeypatch, tmp_path):
    """The scenario of the design beside a library whose header is made."""
    (tmp_path / "libraries").mkdir()
    (tmp_path / "libraries/public_movements.npz").write_bytes(b"made")
    monkeypatch.setattr(libraries, "_tasks", lambda *_: TASKS)
    file = tmp_path / "repack_cell.yaml"
    file.write_text((HERE / "repack_cell.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    return file


def test_the_scenario_of_the_design_is_read(moves):
    loaded = read_scenarios(moves)
    assert list(loaded) == ["base", "near", "both"]
    base, both = loaded["base"].scenario, loaded["both"].scenario
    assert (base.run.horizon_s, base.run.warm_up_s, base.run.start_s, base.run.seed) == (28800.0, 1800.0, 21600.0, 7)
    assert base.tasks["lift_in"].library_task == "deep_squat" and base.tasks["lift_in"].load_kg == 6.0
    assert base.tasks["reach_in"].repeat == 2
    assert base.stations["repack"].servers == 2 and base.stations["repack"].buffer == 4
    assert base.products["crate"].route == ["unload", "store"]
    assert base.release.every_s == 55.0
    assert base.workers["ben"].mass_kg == 58.0 and base.workers["ben"].height_m == 1.85
    assert both.layout.places["rack"] == (6.0, 1.0) and both.workers["eva"] == base.workers["ana"]
    assert task_model(base.tasks["label"], loaded["base"]) == Lognormal(20.0, 0.25, 0.5)


def test_a_task_that_the_library_lacks_is_answered_with_the_nearest(moves):
    moves.write_text(moves.read_text().replace("moves/deep_squat", "moves/deep_sqat"))
    with pytest.raises(ScenarioError) as caught:
        read_scenarios(moves)
    (problem,) = caught.value.problems
    assert (problem.line, problem.message, problem.hint) == (
        10,
        "no task 'deep_sqat' in library 'moves'",
        "did you mean 'deep_squat'?",
    )


def test_given_holds_what_stands_in_the_file_and_nothing_else(moves):
    given_paths = read_scenarios(moves)["both"].given
    assert {"run", "run.horizon", "workers.ben.walk", "workers.eva.skills.repack", "layout.places.rack"} <= given_paths
    assert not {"workers.ben.home", "workers.ben.like", "release.when_full", "overrides"} & given_paths


def test_the_resolved_scenario_reads_back_as_itself(moves):
    for loaded in read_scenarios(moves).values():
        again = scenarios_in(yaml.safe_dump(loaded.resolved).encode(), moves)["base"]
        assert again.scenario == loaded.scenario
        assert again.given == loaded.given


def test_a_loaded_scenario_travels_to_other_processes(moves):
    loaded = read_scenarios(moves)["near"]
    assert pickle.loads(pickle.dumps(loaded)) == loaded


def test_recorded_times_are_read_from_beside_the_scenario(tmp_path):
    (tmp_path / "times.csv").write_text("duration_s\n3\n4\n")
    file = tmp_path / "line.yaml"
    file.write_text(GOOD.replace("fixed: 3 s", "recorded: times.csv, by: trace"))
    loaded = read_scenarios(file)["base"]
    model = task_model(loaded.scenario.tasks["lift"], loaded)
    assert model == Recorded((3.0, 4.0), by_index=True)
    assert np.array_equal(model.at(np.array([0, 3])), [3.0, 4.0])


def test_defaults_are_those_of_the_design():
    text = GOOD.replace("servers: 2, ", "").replace(", buffer: 4", "")
    scenario = scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario
    station, ana = scenario.stations["pack"], scenario.workers["ana"]
    assert (station.servers, station.buffer, ana.walk_m_per_s, ana.home, ana.mass_kg) == (1, None, 1.2, None, None)
    assert (scenario.release.when_full, scenario.allocation.idle) == ("wait", "stay")
    assert (scenario.layout.distance, scenario.libraries) == ("rectilinear", {})


def test_unlimited_is_no_limit():
    text = GOOD.replace("buffer: 4", "buffer: unlimited")
    assert scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.stations["pack"].buffer is None


def test_a_route_may_offer_one_of_several_stations():
    text = GOOD.replace("stations:\n", "stations:\n  other: {like: pack}\n").replace("[pack]}", "[[pack, other]]}")
    text = text.replace("{pack: 1.1}", "{pack: 1.1, other: 1.0}")
    scenario = scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario
    assert scenario.products["carton"].route == [["pack", "other"]]


def with_routing(routing):
    text = GOOD.replace("stations:\n", "stations:\n  check: {like: pack}\n").replace(
        "route: [pack]", f"routing: {routing}"
    )
    text = text.replace("{pack: 1.1}", "{pack: 1.1, check: 1.0}")
    return scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.products["carton"]


def test_a_routing_is_read_as_probabilities_from_each_station():
    product = with_routing("{start: pack, pack: {check: 1/3, pack: 1/3, out: 1/3}, check: out}")
    assert product.route is None
    assert product.routing == {
        "start": {"pack": 1.0},
        "pack": {"check": 1 / 3, "pack": 1 / 3, "out": 1 / 3},
        "check": {"out": 1.0},
    }


def test_a_way_that_is_never_taken_is_left_out():
    product = with_routing("{start: pack, pack: {check: 0, out: 1}, check: out}")
    assert product.routing["pack"] == {"out": 1.0}


def test_probabilities_that_are_rounded_are_scaled_to_a_sum_of_1():
    ways = with_routing("{start: pack, pack: {check: 0.3333333, pack: 0.6666666}, check: out}").routing["pack"]
    assert sum(ways.values()) == pytest.approx(1.0, abs=1e-15)


def test_gaps_between_jobs_may_come_from_a_distribution():
    text = GOOD.replace("{kind: poisson, every: 55 s}", "{kind: renewal, every: {dist: erlang, mean: 55 s, k: 2}}")
    release = scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.release
    assert (release.kind, release.every_s) == ("renewal", 55.0)
    assert time_model(release.gap) == Erlang(55.0, 2)


def test_a_poisson_release_has_a_mean_gap_and_no_model():
    release = scenarios_in(GOOD.encode(), Path("line.yaml"))["base"].scenario.release
    assert (release.every_s, release.gap) == (55.0, None)


def test_a_worker_may_go_round_the_same_station_twice():
    text = GOOD.replace("{rule: nearest}", "{idle: patrol}").replace(
        "skills: {pack: 1.1}", "skills: {pack: 1}, patrol: [pack, pack]"
    )
    scenario = scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario
    assert scenario.workers["ana"].patrol == ["pack", "pack"] and scenario.allocation.idle == "patrol"


def test_staffing_is_fixed_unless_it_is_redrawn():
    assert scenarios_in(GOOD.encode(), Path("line.yaml"))["base"].scenario.run.staffing == "fixed"
    text = GOOD.replace("seed: 7", "seed: 7, staffing: redrawn")
    assert scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.run.staffing == "redrawn"


def test_who_starts_behind_a_one_way_path_need_not_come_back():
    text = GOOD.replace("{like: ana}", "{like: ana, home: door}")
    text = text.replace(
        "  places:\n", "  distance: paths\n  paths: [{from: door, to: bench, one_way: true}]\n  places:\n"
    )
    layout = scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.layout
    assert [(path.start, path.end, path.one_way, path.length_m) for path in layout.path_steps] == [
        ("door", "bench", True, None)
    ]


def test_an_automatic_station_needs_no_worker():
    text = GOOD.replace("load: 6 kg", "automatic: true").replace("skills: {pack: 1.1}", "skills: {}")
    assert scenarios_in(text.encode(), Path("line.yaml"))["base"].scenario.tasks["lift"].automatic


def test_all_problems_of_all_variants_come_once_and_in_order():
    text = GOOD.replace("fixed: 3 s", "fixed: 3").replace("[6 m, 1 m]", "[6, 1 m]").replace("walked_m", "walked")
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("line.yaml"))
    assert [problem.line for problem in caught.value.problems] == [9, 20, 22]


def test_a_scenario_cannot_be_changed_after_reading():
    scenario = scenarios_in(GOOD.encode(), Path("line.yaml"))["base"].scenario
    with pytest.raises(ValueError, match="frozen"):
        scenario.run.seed = 8


def test_editors_can_have_the_schema():
    schema = Scenario.model_json_schema()
    assert schema["$defs"]["Run"]["properties"]["horizon"]["type"] == "string"


def test_a_file_of_4000_lines_is_checked_before_it_costs_much():
    stations = "".join(f"  s{i}:\n    at: bench\n    tasks: [lift]\n    buffer: 3\n" for i in range(1000))
    skills = ", ".join(f"s{i}: 1.0" for i in range(1000))
    text = GOOD.replace("stations:\n", f"stations:\n{stations}").replace("{pack: 1.1}", f"{{pack: 1.1, {skills}}}")
    for wrong in (text, text.replace("at: bench\n", "at: bensh\n")):
        start = time.process_time()
        try:
            scenarios_in(wrong.encode(), Path("line.yaml"))
        except ScenarioError as error:
            assert error.problems
        assert time.process_time() - start < 5  # 0.1 s on a machine of 2026; a square law would take minutes


def test_a_folder_is_not_a_scenario(tmp_path):
    with pytest.raises(ScenarioError, match="cannot be read"):
        read_scenarios(tmp_path)


def read_or_refuse(raw):
    """Reading ends in scenarios that can be planned, or in a ScenarioError that can be printed; else the test fails."""
    try:
        for loaded in scenarios_in(raw, Path("line.yaml")).values():
            assert station_loads(compile_plan(loaded)) and risks_of(loaded.scenario) is not None
    except ScenarioError as error:
        assert error.problems and str(error).splitlines()[-1].split()[1].startswith("problem")
        assert all(problem.message for problem in error.problems)


@given(st.binary(max_size=200) | st.text(max_size=200).map(lambda text: text.encode("utf-8", "replace")))
def test_any_bytes_are_read_or_refused(raw):
    read_or_refuse(raw)


PIECES = st.sampled_from(
    [
        "null",
        "[]",
        "{}",
        "-1",
        "1 s",
        "'",
        ".nan",
        "1e999",
        "[[a], 1]",
        "*a",
        "&a",
        "\n",
        ": ",
        "- ",
        "? ",
        "! ",
        "--- ",
    ]
)


@settings(max_examples=400, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(st.integers(0, len(GOOD)), st.integers(0, 12), PIECES | st.text(max_size=4))
def test_a_good_file_with_a_slip_of_the_pen_is_read_or_refused(at, length, piece):
    read_or_refuse((GOOD[:at] + piece + GOOD[at + length :]).encode("utf-8", "replace"))


def test_every_word_of_the_language_is_read():
    """Each task of ``everything.yaml`` is of another kind."""
    both = scenarios_in(EVERYTHING.encode(), Path("line.yaml"))["both"].scenario
    assert len({type(task) for task in both.tasks.values()}) == len(both.tasks) >= 13
    assert both.workers["cai"] == both.workers["ben"] and both.workers["ben"].skills["pack"] == 0.9
    assert (both.workers["ana"].walk_m_per_s, both.workers["ana"].patrol) == (1.1, ["unload", "pack", "pack2"])


ODD_TEXTS = st.sampled_from(["0 s", "1e-6 s", "8589934592 s", "1e6 m", "0.01 m/s", "out", "start", "unlimited", "1/3"])
ODD = st.none() | st.booleans() | st.integers() | st.floats() | ODD_TEXTS | st.text(max_size=5)


@pytest.mark.parametrize("text", [GOOD, EVERYTHING], ids=["good", "everything"])
@settings(max_examples=90, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(data=st.data())
def test_a_good_file_with_any_value_replaced_is_read_or_refused(text, data):
    tree = yaml.safe_load(text)
    block, key = tree, None
    while isinstance(block, dict | list) and block and (key is None or data.draw(st.booleans())):
        parent = block
        key = data.draw(st.sampled_from(sorted(block) if isinstance(block, dict) else list(range(len(block)))))
        block = parent[key]
    lists, blocks = st.lists(ODD, max_size=3), st.dictionaries(st.text(max_size=5), ODD, max_size=3)
    parent[key] = data.draw(ODD | lists | blocks)
    read_or_refuse(yaml.safe_dump(tree, allow_unicode=True).encode())


def answer(raw):
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(raw, Path("x.yaml"))
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("no", "no"),
        ("NO", "NO"),
        ("on", "on"),
        ("yes", "yes"),
        ("08:30", "08:30"),
        ("1:30:00", "1:30:00"),
        ("010", 10),
        ("0o10", 8),
        ("0x1F", 31),
        ("1_000", "1_000"),
        ("1e3", 1000.0),
        ("-.5", -0.5),
        ("2026-03-02", "2026-03-02"),
        ("true", True),
        ("~", None),
        ("", None),
        (".inf", float("inf")),
        ("9" * 400, "9" * 400),
    ],
)
def test_plain_scalars_follow_the_core_schema_of_yaml_1_2(text, value):
    assert scalar(text) == value and type(scalar(text)) is type(value)


def test_values_know_where_they_stand():
    tree, problems = read_tree(b"a: 1\nb:\n  - x\n  - c: '2'\n", "x.yaml")
    two = child(tree, "b", 1, "c")
    assert not problems
    assert (two.value, two.place.line, two.place.column, two.key.column) == ("2", 3, 7, 4)


def test_a_key_is_the_text_that_stands_there():
    tree, _ = read_tree(b"no: 1\n010: 2\ntrue: 3\n", "x.yaml")
    assert list(tree.value) == ["no", "010", "true"]


def test_an_alias_stands_for_its_anchor():
    tree, _ = read_tree(b"a: &x {k: [1, 2]}\nb: *x\n", "x.yaml")
    assert tree.plain() == {"a": {"k": [1, 2]}, "b": {"k": [1, 2]}}


def test_utf_16_and_a_byte_order_mark_are_read():
    for encoding in ("utf-16", "utf-8-sig"):
        assert read_tree("a: ü\n".encode(encoding), "x.yaml")[0].plain() == {"a": "ü"}


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (b"", "x.yaml: the file is empty\n  a scenario begins with 'opsim: 1'\n1 problem in x.yaml"),
        (b"# nothing yet\n", "x.yaml: the file is empty\n  a scenario begins with 'opsim: 1'\n1 problem in x.yaml"),
        (
            b"PK\x03\x04\x00\x00\xff",
            "x.yaml: this is a binary file, not a scenario\n  a scenario is a YAML text file\n1 problem in x.yaml",
        ),
        (
            b"name: M\xfcller\n",
            "x.yaml:1:8: byte 0xfc is not UTF-8 text\n     1 | name: M\N{REPLACEMENT CHARACTER}\n"
            "       |        ^ save the file as UTF-8\n1 problem in x.yaml",
        ),
        (
            b"a: 1\nname: \x1b[31m\n",
            "x.yaml:2:7: a control character (U+001B) stands here\n     2 | name: ?[31m\n"
            "       |       ^ remove it\n1 problem in x.yaml",
        ),
        (
            b"- a\n",
            "x.yaml:1:1: expected a scenario, found a list of 1\n     1 | - a\n"
            "       | ^ a scenario begins with 'opsim: 1'\n1 problem in x.yaml",
        ),
        (
            b"a: 1\n---\nb: 2\n",
            "x.yaml:2:1: a second document begins here\n     2 | ---\n"
            "       | ^ a file holds one scenario; remove the '---'\n1 problem in x.yaml",
        ),
        (
            b"a:\n\tb: 1\n",
            "x.yaml:2:1: not YAML: a tab stands where the indent is\n     2 |  b: 1\n"
            "       | ^ indent with spaces\n1 problem in x.yaml",
        ),
        (
            b"a: @b\n",
            "x.yaml:1:4: not YAML: a value cannot begin with '@'\n     1 | a: @b\n"
            "       |    ^ put it in quotes\n1 problem in x.yaml",
        ),
        (
            b'a: "b\nc: 1\n',
            'x.yaml:1:4: not YAML: a quote is opened and never closed\n     1 | a: "b\n'
            "       |    ^ close it on the same line\n1 problem in x.yaml",
        ),
        (
            b"a: b: c\n",
            "x.yaml:1:5: not YAML: a second ': ' in one value\n     1 | a: b: c\n"
            "       |     ^ put the value in quotes, or the key on its own line\n1 problem in x.yaml",
        ),
        (
            b"a: &x 1\nb: *y\n",
            "x.yaml:2:4: b: no anchor '&y' before this\n     2 | b: *y\n       |    ^ known: x\n1 problem in x.yaml",
        ),
    ],
)
def test_what_is_no_yaml_text_gets_its_whole_answer(raw, said):
    assert answer(raw) == said


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (b"- " * 100_000, "more than 30 deep"),
        (b"a: 1\n" * 90_000, "this key stands twice"),
        (b"a: !!python/object/apply:os.system [ls]\n", "means nothing here"),
        (b"a: &a [*a]\n", "no anchor '&a' before this"),
        (b"<<: {a: 1}\n", "write 'like: NAME' instead"),
    ],
)
def test_what_yaml_allows_and_a_scenario_does_not_is_refused_quickly(raw, said):
    start = time.process_time()
    assert said in answer(raw)
    assert time.process_time() - start < 5  # a square law would take minutes
