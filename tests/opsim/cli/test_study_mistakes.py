"""Mistakes of who asks for a study: each is answered with its place, what was found and the way out, before any run."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from opsim.cli.study_options import vary_of
from opsim.kpi.targets import check_indifference, read_limit, read_target
from opsim.problems import ScenarioError
from opsim.scenario.fields import EXAMPLES, read_any_moved, read_moved
from opsim.study.jobs.job import Shard
from tests.opsim.cli.calls import LINE, line, opsim

PEOPLE = """
opsim: 1
name: Two <b>people</b>
run: {horizon: 20 min, replications: 2, seed: 3}
layout: {places: {here: [0 m, 0 m], there: [3 m, 0 m], spare: [6 m, 0 m]}}
tasks: {cut: {fixed: 20 s}, drill: {fixed: 25 s}}
stations:
  saw: {at: here, tasks: [cut], buffer: 2}
  press: {at: there, tasks: [drill], buffer: 2}
products: {part: {route: [saw, press]}}
release: {kind: saturated}
workers: {ana: {skills: {saw: 1, press: 1}}, ben: {like: ana}}
overrides: {near: {layout.places.there: [1 m, 0 m]}}
scenarios: {base: [], near: [near]}
outputs: [throughput_per_h, walked_m]
"""
ONE = "--indifference=1"
BUFFERS = "--vary=stations.saw.buffer=1,2"


def refused(folder, *words, text=PEOPLE):
    """What is said of a call that is refused; nothing may have been written."""
    out = folder / "out"
    code, said, told = opsim(words[0], line(folder, text), "-o", out, *words[1:])
    assert code == 2, said + told
    assert not (out / "summary.json").exists()
    assert not list(out.glob("**/*.jsonl")), "begun before it was refused"
    return told


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("sweep",), "nothing says what is varied"),
        (("sweep", "--vary", "foo"), "expected a path, '=' and values; such as"),
        (("sweep", "--vary", "stations.sav.buffer=1,2"), "did you mean stations.saw.buffer?"),
        (("sweep", "--vary", "stations.saw.bufer=1,2"), "did you mean stations.saw.buffer?"),
        (("sweep", "--vary", "buffer=1,2"), "did you mean stations.saw.buffer?"),
        (("sweep", "--vary", "stations.saw.buffer=-1,2"), "must be at least 0, found -1"),
        (("sweep", "--vary", "stations.saw.buffer=1,1"), "1 stands twice among the values"),
        (("sweep", "--vary", "stations.saw.buffer=1,yes"), "expected a whole number or unlimited, found 'yes'"),
        (("sweep", "--vary", "stations.saw.buffer=1..2..3"), "a range has two ends"),
        (("sweep", "--vary", "stations.saw.buffer=5..1", "--levels", "2"), "are the wrong way round"),
        (("sweep", "--vary", "tasks.cut.fixed=10 s..20", "--levels", "2"), "the ends of a range need the same unit"),
        (("sweep", "--vary", "tasks.cut.fixed=10..20", "--levels", "2"), "10 has no unit; expected a time"),
        (("sweep", BUFFERS, BUFFERS), "stations.saw.buffer is given twice"),
        (("sweep", BUFFERS, "--figure", "thruput_per_h"), "did you mean 'throughput_per_h'?"),
        (("sweep", BUFFERS, "--figure", "walked_m/bob"), "walked_m/bob: no worker 'bob'"),
        (("sweep", "--vary", "run.seed=1,2"), "run.seed decides nothing of what happens on the floor"),
        (("sweep", "--vary", "run.horizon=1 h,2 h", "--horizon", "1 h"), "keep one of both"),
        (("sweep", BUFFERS, "--horizon", "20 mins"), "write '20 min'"),
        (("sweep", BUFFERS, "--replications", "0"), "0 is not in the range"),
        (("sweep", BUFFERS, "--scenario", "neer"), "did you mean 'near'?"),
        (("sweep", BUFFERS, "--shard", "3/2"), "the first number must be from 1 to 2"),
        (("sweep", BUFFERS, "--shard", "1/0"), "the second number says how many parts there are, from 1 to 100,000"),
        (("sweep", BUFFERS, "--replications", "1000000000"), "write 1000000 or less"),
        (("sweep", BUFFERS, "--shard", "a"), "expected which of how many, such as 2/8"),
        (("sweep", BUFFERS, "--executor", "dsk:x"), "expected dask:ADDRESS"),
        (("sweep", BUFFERS, "--points", "4", "--design", "grid"), "with --design grid the factors say which"),
        (("labour", "--workforces", "1"), "at least 2 workforces are needed, found 1"),
        (("labour", "--replications", "1"), "at least 2 replications of each workforce are needed, found 1"),
        (("labour", "--target", "throughput_per_h >= many"), "write it such as 'throughput_per_h >= 60'"),
        (("labour", "--target", "thruput_per_h >= 9"), "did you mean 'throughput_per_h'?"),
        (("labour", "--target", "walked_m/an <= 9"), "did you mean 'ana'?"),
        (("labour", "--add", "an"), "did you mean 'ana'?"),
        (("labour", "--figure", "x"), "unknown figure 'x'"),
        (("select",), "nothing says which difference is too small to matter"),
        (("select", ONE, "--best", "wlked_m"), "did you mean 'walked_m'?"),
        (("select", ONE, "--best", "worker_states/ana/wait"), "write 'more worker_states/ana/wait' or 'less worker_s"),
        (("select", ONE, "--best", "walked_m"), "write '1 m' or '1 cm'"),
        (("select", "--indifference", "0"), "expected more than 0, found '0'"),
        (("select", "--indifference", "1 m"), "throughput_per_h is per hour"),
        (("select", ONE, "--confidence", "95"), "must be less than 1, found 95"),
        (("select", ONE, "--among", "base,neer"), "did you mean 'near'?"),
        (("select", ONE, "--among", "near,near"), "'near' is named twice"),
        (("select", ONE, "--base", "bse"), "did you mean 'base'?"),
        (("select", ONE, "--subject-to", "walked_m/worst < 9 m"), "write a figure, <= or >=, and a number"),
        (("select", ONE, "--subject-to", "walked_m/bob <= 9 m"), "no worker 'bob'"),
        (("select", ONE, "--subject-to", "walked_m/worst <= 9"), "write '9 m' or '9 cm'"),
        (("select", ONE, "--vary", "stations.saw.bufer=1,2"), "did you mean stations.saw.buffer?"),
        (("select", ONE, "--shard", "1/2"), "--shard: which replications are needed next depends"),
        (("layout", "--swap", "saw,pres"), "did you mean 'press'?"),
        (("layout", "--move", "here=6, 1 m"), "6 has no unit"),
        (("layout", "--place", "saw=spar"), "did you mean 'spare'?"),
        (("layout", "--fixed", "sow"), "did you mean 'saw'?"),
        (("layout", "--shard", "1/2"), "--shard: "),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, tuple) else "",
)
def test_a_wrong_option_is_refused_before_any_run(tmp_path, words, said):
    assert said in refused(tmp_path, *words)


def test_a_study_of_a_scenario_that_is_wrong_too_says_all_at_once(tmp_path):
    told = refused(tmp_path, "sweep", "--vary=stations.sav.buffer=1,2", text=LINE.replace("fixed: 25 s", "fixed: 25"))
    assert "25 has no unit" in told
    assert "did you mean stations.saw.buffer?" in told
    assert "2 problems in " in told


def test_what_stands_in_the_file_is_refused_at_its_line(tmp_path):
    text = LINE + "studies:\n  sweep:\n    vary: {stations.sav.buffer: [1, 2], stations.saw.buffer: {from: 3, to: 1}}\n"
    told = refused(tmp_path, "sweep", text=text)
    assert "line.yaml:17:12: stations.sav.buffer: no 'sav' among the stations" in told
    assert "line.yaml:17:62: studies.sweep.vary.stations.saw.buffer: the ends of the range" in told
    code, _, said = opsim("check", line(tmp_path, text))
    assert (code, said) == (2, told)


MORE = {"sweep": (BUFFERS,), "select": (ONE,), "labour": (), "layout": ()}


@pytest.mark.parametrize("verb", MORE)
def test_a_file_that_is_not_there_and_a_folder_that_cannot_be_are_said(tmp_path, verb):
    code, _, told = opsim(verb, tmp_path / "lime.yaml")
    assert code == 2
    assert "lime.yaml: no such file" in told
    taken = tmp_path / "taken"
    taken.write_text("mine")
    people = PEOPLE.replace("{fixed: 20 s}", "{dist: lognormal, mean: 20 s, cv: 0.3, between_share: 0.4}")
    for folder, said in ((taken, "taken is a file, not a folder"), (taken / "in", "Not a directory")):
        code, _, told = opsim(verb, line(tmp_path, people), "-o", folder, *MORE[verb])
        assert code == 2
        assert said in told
    assert taken.read_text() == "mine"


def test_a_folder_with_the_results_of_a_run_is_left_alone(tmp_path):
    out = tmp_path / "out"
    assert opsim("run", line(tmp_path, PEOPLE), "-o", out, "--scenario", "base")[0] == 0
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    for folder in (out, out / "base"):
        code, _, told = opsim("sweep", line(tmp_path, PEOPLE), "-o", folder, BUFFERS)
        assert code == 2, told
        assert "take another folder with -o" in told
    assert {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} == before


PIECES = [
    *("stations.saw.buffer", "=", "1", ",", "..", "40 s", "throughput_per_h", "<=", "+-", "%", "/", "9" * 400, "1e999"),
    *("swap", "saw", "nan", "-", " a day", "[", "]", "{", ": ", "'", "#", "*", "&", "like", " at ", "\x1b"),
]


@pytest.mark.parametrize("folders", [(), ("nowhere",), ("lines",)])
def test_merge_of_what_is_no_study_is_refused(tmp_path, folders):
    (tmp_path / "lines").mkdir()
    (tmp_path / "lines" / "study.json").write_text("{}")
    code, _, told = opsim("merge", *(tmp_path / folder for folder in folders))
    assert code == 2
    assert told


FORMS = st.one_of(
    st.text(max_size=20),
    st.lists(st.sampled_from(PIECES), max_size=8).map("".join),
)
READERS = {
    "--vary": lambda text: vary_of([text]),
    "--subject-to": read_limit,
    "--target": read_target,
    "--shard": Shard.read,
    "--indifference": lambda text: check_indifference(text, "walked_m"),
    "a change of a layout": read_any_moved,
    **{f"--{kind}": lambda text, kind=kind: read_moved(kind, text) for kind in EXAMPLES},
}


@pytest.mark.parametrize("option", READERS)
@settings(max_examples=60, deadline=None)
@given(text=FORMS)
def test_any_text_of_an_option_is_read_or_refused_in_words(option, text):
    try:
        READERS[option](text)
    except (ValueError, ScenarioError) as error:
        assert str(error)
