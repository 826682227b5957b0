import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.external_draws import human_of
from opsim.files import NotInside, inside
from opsim.problems import MOST_SHOWN, Problem, ScenarioError, did_you_mean, natural_key, nearest, nearest_file, shown
from opsim.subjects.human.fatigue import Lffrm, RestByNeed
from opsim.subjects.human.plan import NO_EFFECTS, HumanPlan
from opsim.units import UNITS, UnitError, parse, written


@pytest.mark.parametrize(
    ("text", "kind", "si"),
    [
        ("45 s", "time", 45.0),
        ("45s", "time", 45.0),
        (" 1.5 h ", "time", 5400.0),
        ("1 min 30 s", "time", 90.0),
        ("1h30min", "time", 5400.0),
        ("250 ms", "time", 0.25),
        ("2 d", "time", 172800.0),
        ("00:45:00", "time", 2700.0),
        ("8:00:00.5", "time", 28800.5),
        ("1e3 s", "time", 1000.0),
        (".5 s", "time", 0.5),
        ("-2 m", "length", -2.0),
        ("5 ft 11 in", "length", 1.8034),
        ("80 cm", "length", 0.8),
        ("4.5 km/h", "speed", 1.25),
        ("60 m/min", "speed", 1.0),
        ("600 g", "mass", 0.6),
        ("180 deg", "angle", math.pi),
        ("0.2 rad", "angle", 0.2),
        ("1.1 h", "time", 3960.0),  # 1.1 * 3600 in floats is 3960.0000000000005
    ],
)
def test_a_quantity_is_read_to_the_nearest_float(text, kind, si):
    assert parse(text, kind) == si


@pytest.mark.parametrize(
    ("value", "kind", "said"),
    [
        (30, "time", "30 has no unit; expected a time; write '30 s', '30 min' or '30 h'"),
        ("30", "time", "30 has no unit; expected a time; write '30 s', '30 min' or '30 h'"),
        ("8 hours", "time", "unknown unit 'hours'; write '8 h'"),
        ("1 hour 30 mins", "time", "unknown unit 'hour'; write '1 h 30 min'"),
        ("20 secs", "time", "unknown unit 'secs'; write '20 s'"),
        ("8 H", "time", "unknown unit 'H'; write '8 h'"),
        ("2 weks", "time", "unknown unit 'weks'; units of time: ms, s, min, h, d"),
        ("2 mn", "time", "unknown unit 'mn'; did you mean 'min'? units of time: ms, s, min, h, d"),
        ("80 cmm", "length", "unknown unit 'cmm'; did you mean 'cm'? units of length: mm, cm, m, km, in, ft"),
        ("5 kg", "time", "'5 kg' is a mass; expected a time; such as '45 s'"),
        ("5 kg", "angle", "'5 kg' is a mass; expected an angle; such as '10 deg'"),
        ("10 deg", "mass", "'10 deg' is an angle; expected a mass; such as '6 kg'"),
        (10, "angle", "10 has no unit; expected an angle; write '10 deg' or '10 rad'"),
        ("10 degrees", "angle", "unknown unit 'degrees'; write '10 deg'"),
        ("10\u00b0", "angle", "unknown unit '\u00b0'; write '10 deg'"),
        ("1,5 s", "time", "cannot read '1,5 s' as a time; write a decimal point: '1.5 s'"),
        (
            "45:00",
            "time",
            "'45:00' may be hours and minutes or minutes and seconds; write '45 h 0 min' or '45 min 0 s'",
        ),
        ("1:2:3:4", "time", "cannot read '1:2:3:4' as a time; write '45 s', '1 min 30 s' or a clock '00:45:00'"),
        ("30 s 1 min", "time", "cannot read '30 s 1 min' as a time; write one number and one unit, or '1 min 30 s'"),
        ("1 min -30 s", "time", "cannot read '1 min -30 s' as a time; write one number and one unit, or '1 min 30 s'"),
        ("1e99 s", "time", "found '1e99 s', expected a number from 1e-30 to 1e+30 before the unit"),
        ("", "time", "expected a time, found empty text; write a number and its unit, such as '45 s'"),
        ("soon", "time", "cannot read 'soon' as a time; write a number and its unit, such as '45 s'"),
        (float("inf"), "time", "expected a time, found inf; write a finite number with its unit: '45 s'"),
        (float("nan"), "mass", "expected a mass, found nan; write a finite number with its unit: '6 kg'"),
        (True, "mass", "expected a mass, found true; write it with its unit, such as '6 kg'"),
        (None, "length", "expected a length, found nothing; write it with its unit, such as '1.5 m'"),
        ([1], "speed", "expected a speed, found a list of 1; write it with its unit, such as '1.2 m/s'"),
    ],
)
def test_what_is_no_quantity_is_answered_with_the_way_out(value, kind, said):
    with pytest.raises(UnitError) as caught:
        parse(value, kind)
    assert str(caught.value) == said


@given(
    st.sampled_from(sorted(UNITS)),
    st.integers(-(10**6), 10**6),
    st.integers(0, 3),
    st.sampled_from(["", " ", "  "]),
    st.data(),
)
def test_every_unit_scales_its_number(kind, number, decimals, space, data):
    unit = data.draw(st.sampled_from(sorted(UNITS[kind])))
    text = f"{number / 10**decimals:.{decimals}f}"
    assert parse(f"{text}{space}{unit}", kind) == pytest.approx(float(text) * float(UNITS[kind][unit]), rel=1e-15)


@given(st.integers(0, 999), st.integers(0, 59), st.integers(0, 59))
def test_clock_and_parts_mean_the_same(hours, minutes, seconds):
    parts = parse(f"{hours} h {minutes} min {seconds} s", "time")
    assert parse(f"{hours}:{minutes:02d}:{seconds:02d}", "time") == parts == hours * 3600 + minutes * 60 + seconds


@given(st.text(max_size=30) | st.text("0123456789.,:+-eE smhind/kg", max_size=20), st.sampled_from(sorted(UNITS)))
def test_any_text_is_a_finite_number_or_a_unit_error(text, kind):
    try:
        assert abs(parse(text, kind)) < 1e40
    except UnitError as error:
        assert error.message


@pytest.mark.parametrize(
    ("text", "kind"), [("45 deg", "angle"), ("2.5 s", "time"), ("0.25 m", "length"), ("6 kg", "mass")]
)
def test_what_is_written_is_what_was_read(text, kind):
    assert written(parse(text, kind), kind) == text


def test_numbers_in_names_are_read_as_numbers():
    assert sorted(["w10", "w2", "w1b", "w", "w01", "a9"], key=natural_key) == ["a9", "w", "w01", "w1b", "w2", "w10"]


@given(st.lists(st.text(max_size=8), unique=True, max_size=20), st.randoms())
def test_the_order_is_the_same_whatever_comes_first(names, random):
    shuffled = names[:]
    random.shuffle(shuffled)
    assert sorted(names, key=natural_key) == sorted(shuffled, key=natural_key)


def test_a_problem_points_with_a_caret_at_its_column():
    problem = Problem("line.yaml", 12, 5, "run.sed", "unknown key 'sed'", "did you mean 'seed'?", "run: {sed: 7}")
    assert str(problem) == (
        "line.yaml:12:5: run.sed: unknown key 'sed'\n    12 | run: {sed: 7}\n       |     ^ did you mean 'seed'?"
    )


def test_a_long_line_is_shown_around_its_column():
    line = "x" * 5000 + "HERE" + "y" * 5000
    printed = str(Problem("a.yaml", 1, 5001, "", "found it", "", line)).splitlines()
    assert max(map(len, printed)) < 200
    assert printed[1][printed[2].index("^") :].startswith("HERE")


def test_the_total_counts_all_and_shows_the_first():
    error = ScenarioError([Problem("a.yaml", n, 1, "", f"wrong {n}") for n in range(1, 101)])
    assert str(error).count("wrong") == MOST_SHOWN
    assert str(error).endswith(f"100 problems in a.yaml (the first {MOST_SHOWN} are shown)")


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (None, "nothing"),
        (True, "true"),
        ("a\x1b[31m", "'a\\x1b[31m'"),
        ({}, "a block of keys"),
        ([], "an empty list"),
        (2, "2"),
    ],
)
def test_a_value_is_shown_in_printable_words(value, words):
    assert shown(value) == words
    assert len(shown("x" * 10_000)) <= 60


def test_the_nearest_word_is_found_whatever_its_case():
    assert nearest("Pelvsi", ["pelvis", "spine"]) == "pelvis"
    assert nearest("Munday", ["Monday", "Sunday"]) == "Monday" and nearest("Sumday", ["Monday", "Sunday"]) == "Sunday"
    assert nearest("zebra", ["pelvis", "spine"]) is None
    assert nearest_file("tmes.csv", ["t.csv", "sub/times.csv"]) == "sub/times.csv"
    assert nearest_file("nope.npz", ["junk.npz", "o.npz"]) is None
    assert did_you_mean("zebra", ["pelvis", "spine"]) == "known: pelvis, spine"
    assert did_you_mean("zebra", []) == ""


@pytest.mark.parametrize(
    "name", ["../x.csv", "/etc/passwd", "a/../../x", "C:/x", "\\\\host\\x", "..\\x", "", " ", "a\0b", "x" * 600]
)
def test_a_name_that_leads_out_is_refused(tmp_path, name):
    with pytest.raises(NotInside):
        inside(name, tmp_path)


def test_the_first_folder_that_has_the_file_wins(tmp_path):
    for folder in ("one", "two"):
        (tmp_path / folder / "sub").mkdir(parents=True)
    (tmp_path / "two/sub/x.csv").write_text("1\n")
    assert inside("sub/x.csv", tmp_path / "one", tmp_path / "two") == tmp_path / "two/sub/x.csv"
    (tmp_path / "one/sub/x.csv").write_text("1\n")
    assert inside("sub/x.csv", tmp_path / "one", tmp_path / "two") == tmp_path / "one/sub/x.csv"
    assert inside("sub", tmp_path / "one") is None


MODELS = {"w10": None, "w2": None}


def read(said, experience=None, start_s=0.0):
    return human_of("ana", said, experience, MODELS, start_s)


def test_words_are_read_as_in_a_scenario():
    plan = read({"fatigue": {"model": "lffrm", "tires_half_in": "2 h"}, "acts_on": "time"})
    assert plan.fatigue == Lffrm(tires_half_in_s=7200.0) and plan.acts_on == "time" and plan.learning is None
    assert read(HumanPlan(fatigue=Lffrm())).fatigue == Lffrm()
    assert read(HumanPlan(fatigue=Lffrm(), start_s=60.0)).start_s == 60.0
    assert read(None) is NO_EFFECTS and not read({}).any


def test_experience_is_by_task_in_natural_order():
    learning = {"learning": {"model": "wright"}}
    assert read(learning, {"w10": 7}).experience == ((0.0, 7.0),)
    assert read(learning, {"w2": 0}).experience == () and read(learning, start_s=60).start_s == 60.0


@pytest.mark.parametrize(
    ("said", "found"),
    [
        (
            {"fatigue": {"model": "lfrm"}},
            "worker ana: human.fatigue.model: no model of fatigue is called 'lfrm'; did you",
        ),
        ({"fatigue": {"model": "lffrm", "slow": 1}}, "human.fatigue.slow: unknown key 'slow'; did you mean 'slows'?"),
        ({"fatigue": {"model": "lffrm", "tires_half_in": 7200}}, "human.fatigue.tires_half_in:"),
        ({"fatigue": {"model": "lffrm", "slows": -1}}, "human.fatigue.slows: must be at least 0, found -1"),
        ({"fatigue": "lffrm"}, "human.fatigue: expected a block of keys, found 'lffrm'; write {model: lffrm}"),
        (
            {"error": {}},
            "human.error: unknown key 'error'; here are: acts_on, circadian, fatigue, forgetting, learning",
        ),
        ({"fatige": {}}, "human.fatige: unknown key 'fatige'; did you mean 'fatigue'?"),
        ({"state_pace": {"model": "schultz"}}, "human.state_pace: not in a model of your own; it looks at the buffers"),
        ({"rest": {"above": 0.5}}, "human.rest: not in a model of your own; who sends your workers is your model"),
        ({"errors": {"at_full_fatigue": 0.1}}, "human.errors: not in a model of your own"),
        ({"absence": 0.1}, "human.absence: not in a model of your own"),
        ({"forgetting": {"model": "lfcm"}}, "human.forgetting: nothing is forgotten where nobody learns"),
        (HumanPlan(experience=((1.0, 2.0),)), "give the Worker experience={task: n}"),
        (HumanPlan(rest=RestByNeed(above=0.5, until=0.2)), "human.rest: not in a model of your own"),
    ],
)
def test_a_mistake_is_named_with_its_place_and_the_nearest_word(said, found):
    with pytest.raises(ValueError) as caught:
        read(said)
    assert found in str(caught.value)


def test_all_mistakes_are_said_at_once():
    with pytest.raises(ValueError) as caught:
        read({"rest": {}, "fatigue": {"model": "lffrm", "slows": -1, "slwo": 3}})
    assert len(str(caught.value).splitlines()) == 3


def test_what_is_no_mapping_or_no_number_is_refused():
    with pytest.raises(TypeError, match="expected a mapping of effects or a HumanPlan, found 3"):
        read(3)
    with pytest.raises(TypeError, match="expected a mapping of tasks"):
        read(None, [3])
    learning = {"learning": {"model": "wright"}}
    with pytest.raises(ValueError, match="no task 'w3'") as caught:
        read(learning, {"w3": 1, "w2": -1})
    assert "experience of w2: found -1, expected repetitions from 0" in str(caught.value)
    with pytest.raises(ValueError, match="where nobody learns"):
        read(None, {"w2": 5})
    with pytest.raises(ValueError, match="start_s must be seconds"):
        read(None, start_s="06:00")
