"""The schema for editors accepts what the reader accepts, and finds what can be found without looking names up.

It was also tried with the jsonschema package and with yaml-language-server 1.25; neither is needed here."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim import units
from opsim.problems import ScenarioError
from opsim.scenario.fields import NAME_PATTERN, is_name
from opsim.scenario.json_schema import FILE_NAME, json_schema, schema_text
from opsim.scenario.paths import step, top, words
from opsim.scenario.read import scenarios_in, variant_trees
from opsim.scenario.yaml import read_tree
from opsim.shipped import shipped_folder
from tests.json_schema import complaints

HERE = Path(__file__).parent
GOOD = (HERE / "good.yaml").read_text(encoding="utf-8")
SCHEMA = json_schema()
FILES = sorted(
    [*shipped_folder().glob("*.yaml"), *(HERE.parents[1] / "known_answers").glob("*.yaml"), *HERE.glob("*.yaml")]
)


def wrong(text):
    # NOTE: our own reader, since editors read YAML 1.2 as it does: 14:00 is text, and no number in base 60
    return list(complaints(read_tree(text.encode(), "file.yaml")[0].plain(), SCHEMA))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_scenarios_that_are_right_are_right_for_the_editor(file):
    assert not wrong(file.read_text(encoding="utf-8"))


def test_the_shipped_schema_is_this_one_and_the_shipped_scenarios_name_it():
    assert (shipped_folder() / FILE_NAME).read_text(encoding="utf-8") == schema_text()
    for file in shipped_folder().glob("*.yaml"):
        first = file.read_text(encoding="utf-8").splitlines()[0]
        assert first == f"# yaml-language-server: $schema=./{FILE_NAME}"


def with_task(task):
    return GOOD.replace("{fixed: 3 s, load: 6 kg}", f"{{{task}}}")


RIGHT = [
    with_task("dist: normal, mean: 3 s, sd: 1 s"),
    with_task("dist: empirical, values: [3 s, 00:00:04]"),
    GOOD.replace("{kind: poisson, every: 55 s}", "{kind: renewal, every: {dist: erlang, mean: 55 s, k: 2}}"),
    GOOD.replace("route: [pack]", "routing: {start: pack, pack: {pack: 1/3, out: 2/3}}"),
    GOOD.replace("route: [pack]", "route: [[pack, pack], pack]"),
    GOOD.replace("buffer: 4", "buffer: unlimited"),
    GOOD.replace(
        "  places:", "  distance: paths\n  paths: [[door, bench], {from: door, to: bench, length: 3 m}]\n  places:"
    ),
    GOOD.replace("tasks:\n", "defaults: {tasks: {load: 3 kg}, workers: {walk: 1 m/s}}\ntasks:\n"),
    "opsim: 1\ninclude: common.yaml\nworkers: {ana: {walk: 1 m/s}}\n",
    GOOD.replace("[0 m, 0 m]", "[-2 m, 1 ft 3 in]"),
    GOOD.replace("[0 m, 0 m]", "{at: [0 m, 0 m], levels: {low: 30 cm}, surface: 1 m, depth: 0.4 m}"),
    with_task("emulator: w/lift, hands: {grasp: door.low, set_down: 0.9 m}")
    .replace("[0 m, 0 m]", "{at: [0 m, 0 m], levels: {low: 40 cm}}")
    .replace("workers:\n", "libraries: {w: libraries/bench_work.npz}\nworkers:\n"),
    GOOD.replace("like: ana", "like: ana, age: 41 years, sex: m, pace: 0.9"),
    GOOD.replace(
        "workers:\n", "workforce: {n: 12, from: population, prefix: q, like: ana, skills: {pack: 1}}\nworkers:\n"
    ),
    GOOD.replace("workers:\n", "libraries: {w: libraries/walking.npz}\nwalking: {emulator: w/walk}\nworkers:\n"),
    GOOD.replace("every: 55 s}", "every: 55 s, at_once: 3, products: {carton: 3/3}}"),
    GOOD.replace("release: {kind: poisson, every: 55 s}", "sources: {a: {kind: saturated, sequence: [carton]}}"),
    GOOD.replace("workers:\n", "cards: {loop: {n: 3, from: pack, to: [pack], products: carton}}\nworkers:\n"),
    GOOD.replace("{pack: 1.1}", "{pack: expert}").replace("workers:\n", "skill_levels: {expert: 1.15}\nworkers:\n"),
    GOOD.replace("{pack: 1.1}", "{pack: {quality: 0.9}}").replace(
        "workers:\n", "skill_levels: {expert: {pace: 1.15, quality: 1}}\nworkers:\n"
    ),
]
WRONG = [
    (GOOD.replace("horizon: 8 h", "horizon: 8"), ".run.horizon: not a string"),
    (GOOD.replace("horizon: 8 h", "horizon: 8 hours"), ".run.horizon: '8 hours' does not look right"),
    (GOOD.replace("servers: 2", "server: 2"), ".stations.pack: unknown key server"),
    (GOOD.replace("at: bench, ", ""), ".stations.pack: at is missing"),
    (GOOD.replace("[0 m, 0 m]", "{at: [0 m, 0 m], level: {low: 1 m}}"), ".layout.places.door: none of 2 fits"),
    (GOOD.replace("[0 m, 0 m]", "{at: [0 m, 0 m], levels: {low: 1}}"), ".layout.places.door: none of 2 fits"),
    (with_task("emulator: w/lift, hands: {grasp: 0.4}"), ".tasks.lift: none of"),
    (GOOD.replace("name: One bench\n", ""), ": name is missing"),
    (GOOD.replace("walked_m", "walked"), ".outputs[0]: 'walked' is not among"),
    (GOOD.replace("start: Mon 06:00", "start: '06:00'"), ".run.start: '06:00' does not look right"),
    (GOOD.replace("{pack: 1.1}", "{pack: 11}"), ".workers.ana.skills.pack: none of 2 fits"),
    (GOOD.replace("{route: [pack]}", "{share: 1}"), ".products.carton: none of 2 fits"),
    (GOOD.replace("workers:\n", "walking: {}\nworkers:\n"), ".walking: emulator is missing"),
    (GOOD.replace("workers:\n", "walking: {emulator: w/walk, by: foot}\nworkers:\n"), ".walking: unknown key by"),
    (GOOD.replace("workers:\n", "workforce: {from: population}\nworkers:\n"), ".workforce: n is missing"),
    (GOOD.replace("workers:\n", "workforce: {n: 3, person: s03}\nworkers:\n"), ".workforce: unknown key person"),
    (GOOD.replace("like: ana", "like: ana, age: 4"), ".workers.ben.age: none of 2 fits"),
    (GOOD.replace("like: ana", "like: ana, age: 41 y"), ".workers.ben.age: none of 2 fits"),
    (GOOD.replace("like: ana", "like: ana, pace: 11"), ".workers.ben.pace: 11 is beyond"),
    (GOOD.replace("release:", "#"), ": none of 2 fits"),
    (GOOD.replace("every: 55 s}", "every: 55 s, products: {carton: 2}}"), ".release.products: none of 2 fits"),
    (GOOD.replace("workers:\n", "cards: {loop: {n: 0}}\nworkers:\n"), ".cards.loop.n: 0 is beyond 1"),
    (with_task("dist: lognormal, mean: 3 s"), ".tasks.lift: none of"),
    (with_task("dist: lognormall, mean: 3 s, cv: 0.2"), ".tasks.lift: none of"),
    (with_task("fixed: 3 kg"), ".tasks.lift: none of"),
    (GOOD.replace("  ben:", "  'be.n':"), ".workers.be.n: 'be.n' does not look right"),
]


@pytest.mark.parametrize("text", RIGHT)
def test_the_editor_accepts_every_form(text):
    assert not wrong(text)


@pytest.mark.parametrize(("text", "said"), WRONG, ids=[said for _, said in WRONG])
def test_the_editor_finds_what_is_wrong(text, said):
    assert any(one.startswith(said) for one in wrong(text)), wrong(text)


def keys_in(node, place=""):
    """(place, what is said of it) of every key that a scenario can have, at any depth; conditions say nothing new."""
    if isinstance(node, list):
        for number, one in enumerate(node):
            yield from keys_in(one, f"{place}[{number}]")
    elif isinstance(node, dict):
        for key, one in node.get("properties", {}).items():
            yield f"{place}.{key}", one
            yield from keys_in(one, f"{place}.{key}")
        for name, one in node.get("definitions", {}).items():
            yield from keys_in(one, name)
        for word in ("additionalProperties", "items", "anyOf"):
            yield from keys_in(node.get(word), place)


KEYS = dict(keys_in(SCHEMA))


def listed(one):
    """Whether an editor can offer every value by itself, or asks the block that is referred to."""
    ways = one.get("anyOf", [one])
    return "$ref" in one or all(way.get("type") == "boolean" or {"enum", "const", "$ref"} & {*way} for way in ways)


def test_there_are_keys_at_every_depth():
    assert len(KEYS) > 500 and {".run", "Run.horizon", "Inspect.then[1].rework", ".defaults.stations"} <= {*KEYS}


def test_every_key_says_what_it_is():
    assert not [place for place, one in KEYS.items() if not one.get("description", "").strip()]


def test_every_figure_that_may_be_asked_for_says_what_it_is_and_its_unit():
    items = SCHEMA["properties"]["outputs"]["items"]
    said = dict(zip(items["enum"], items["enumDescriptions"], strict=True))
    assert said["walked_m"] == "Walked [m]" and said["experience"] == "Repetitions of the task behind somebody"


def test_every_key_has_an_example_unless_its_values_are_listed():
    assert not [place for place, one in KEYS.items() if "examples" not in one and not listed(one)]


def test_every_quantity_says_its_units():
    patterns = {units.pattern(kind): kind for kind in units.UNITS}
    for place, one in KEYS.items():
        kind = patterns.get(one.get("pattern", ""))
        assert kind is None or f"in {', '.join(units.UNITS[kind])}" in one["description"], place


def test_examples_and_defaults_are_what_the_schema_allows():
    for place, one in KEYS.items():
        for value in [*one.get("examples", []), *([one["default"]] if "default" in one else [])]:
            told = {word: said for word, said in one.items() if word not in ("examples", "default")}
            assert not list(complaints(value, told, SCHEMA)), (place, value)


def test_it_says_which_language_it_describes_and_in_which_draft():
    assert SCHEMA["$schema"] == "http://json-schema.org/draft-07/schema#"
    assert SCHEMA["$id"] == "urn:opsim:scenario:1" and SCHEMA["title"] == "opsim scenario"


@given(st.sampled_from(sorted(units.UNITS)), st.text("0123456789.:+-eE smhind/kgft", max_size=12))
def test_what_is_read_as_a_quantity_looks_like_one(kind, text):
    try:
        size = units.parse(text, kind)
    except units.UnitError:
        return
    told = {"pattern": units.pattern(kind)}
    assert fine(text, told) or (size <= 0 and kind != "length")


@given(st.text(max_size=12))
def test_what_can_be_a_name_looks_like_one(text):
    assert fine(text, {"pattern": NAME_PATTERN}) or not is_name(text)


def fine(value, schema):
    return not list(complaints(value, schema))


def test_the_reader_agrees_that_the_right_ones_are_right():
    for text in RIGHT:
        if "include" not in text:
            scenarios_in(text.encode(), Path("line.yaml"))
    for text, _ in WRONG:
        with pytest.raises(ScenarioError):
            scenarios_in(text.encode(), Path("line.yaml"))


def test_the_schema_is_plain_json():
    assert json.loads(schema_text()) == SCHEMA


KNOWN_PATHS_HERE = Path(__file__).parent
KNOWN_PATHS_FILES = sorted(
    [*shipped_folder().glob("*.yaml"), KNOWN_PATHS_HERE / "everything.yaml", KNOWN_PATHS_HERE / "good.yaml"]
)


def spot_at(root, path):
    spot = top(root)
    for part in path.split("."):
        spot = spot and step(root, spot, part)
    return spot


def leaves(value, path=()):
    if not isinstance(value, dict) or not value:
        yield path
        return
    for key, below in value.items():
        yield from leaves(below, (*path, key))


@pytest.mark.parametrize("file", KNOWN_PATHS_FILES, ids=lambda file: file.stem)
def test_every_path_that_stands_in_a_right_scenario_is_known(file):
    for tree in variant_trees(file)[1].values():
        for path in leaves(tree.plain()):
            spot = top(tree)
            for part in path:
                if part == "opsim":
                    break
                assert part in words(tree, spot), path
                spot = step(tree, spot, part)
                assert spot is not None, path


def test_keys_that_are_not_written_are_known_too():
    root = variant_trees(KNOWN_PATHS_HERE / "good.yaml")[1]["base"]
    for path in ("run.posture", "human.learning.rate", "stations.pack.breakdowns.jam.repair", "defaults.workers.walk"):
        assert spot_at(root, path) is not None
    assert spot_at(root, "stations.pack.sarvers") is None
    assert spot_at(root, "opsim") is None


def test_what_is_copied_by_like_and_defaults_shines_through():
    root = variant_trees(KNOWN_PATHS_HERE / "good.yaml")[1]["base"]
    assert spot_at(root, "workers.ben.skills.pack").node.value == 1.1
    assert "like" in words(root, spot_at(root, "workers.ben"))
