"""A study as its user runs it: gone on with, split, merged, refused; with a made study instead of a real one.

Mistakes of who asks for a study: each is answered with its place, what was found and the way out, before any run.
"""

import hashlib
import json
import os
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from stand_in_engine import stand_in

from opsim.cli.study_options import vary_of
from opsim.kpi.catalogue import Figure
from opsim.kpi.targets import check_indifference, read_limit, read_target
from opsim.problems import ScenarioError
from opsim.scenario.fields import EXAMPLES, read_any_moved, read_moved
from opsim.study.jobs.job import Answer, Shard
from opsim.study.jobs.journal import Journal
from tests.made import study as made_study
from tests.opsim.cli.calls import LINE, line, opsim

STUDY = LINE + "studies: {sweep: {vary: {stations.saw.buffer: [1, 2, 4]}}}\n"
BYTES = ("summary.json", "figures.parquet", "sweep.html", "study.json")


@pytest.fixture(autouse=True)
def in_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("opsim.cli.sweep.KIND", made_study.KIND, raising=False)
    monkeypatch.setattr("opsim.cli.sweep.command", made_study.command)
    line(tmp_path, STUDY)


def hashes(folder):
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in BYTES]


def swept(*words):
    code, out, err = opsim("sweep", "line.yaml", *words)
    assert code == 0, err
    return out


@pytest.fixture
def whole(tmp_path):
    swept("-o", "whole", "--processes", 1)
    return hashes(tmp_path / "whole")


def test_a_study_is_told_on_a_screen_and_in_files_and_found_again(tmp_path, whole):
    (tmp_path / "whole" / "summary.json").unlink()
    code, out, err = opsim("sweep", "line.yaml", "-o", "whole")
    assert code == 0 and "buffer 4" in out and "whole/sweep.html" in out and " of " not in err
    assert hashes(tmp_path / "whole") == whole


@pytest.mark.slow
def test_two_processes_give_the_bytes_of_one(tmp_path, whole):
    swept("-o", "two", "--processes", 2)
    assert hashes(tmp_path / "two") == whole


def test_shards_in_any_folders_give_the_bytes_of_the_whole(tmp_path, whole):
    for shard, folder in (("1/3", "a"), ("3/3", "a"), ("2/3", "b")):
        out = swept("-o", folder, "--shard", shard)
        assert f"shard {shard}: 2 of 6 replications are in {folder}" in out and "opsim merge" in out
        assert not (tmp_path / folder / "summary.json").exists()
    assert opsim("merge", "a", "b", "-o", "merged")[0] == 0
    assert hashes(tmp_path / "merged") == whole


def test_the_same_file_by_another_path_gives_the_same_bytes(tmp_path, whole):
    for name, path in (("a", tmp_path / "line.yaml"), ("b", "./line.yaml")):
        assert opsim("sweep", str(path), "-o", name, "--processes", 1)[0] == 0
        assert hashes(tmp_path / name) == whole


def test_shards_of_one_folder_are_merged_where_they_are(tmp_path, whole):
    swept("-o", "s", "--shard", "1/2")
    assert "and so are all others" in swept("-o", "s", "--shard", "2/2")
    assert opsim("merge", "s")[0] == 0
    assert hashes(tmp_path / "s") == whole


def said(folder):
    """What a folder says of engines; None: SimPy alone."""
    path = folder / "engine.json"
    return json.loads(path.read_text()) if path.exists() else None


BY_FAST = {"asked": "fast", "used": {"fast": "as asked"}}
BOTH = {"fast": "as asked", "simpy": "which is the reference"}


@pytest.mark.parametrize(
    ("of_a", "of_b", "found"),
    [
        ("fast", "fast", BY_FAST),
        ("simpy", "fast", {"asked": "fast, simpy", "used": BOTH}),
        ("simpy", "simpy", None),
    ],
)
def test_a_merged_study_says_which_engines_answered_its_shards(tmp_path, monkeypatch, whole, of_a, of_b, found):
    stand_in(monkeypatch)
    swept("-o", "a", "--shard", "1/2", "--engine", of_a)
    swept("-o", "b", "--shard", "2/2", "--engine", of_b)
    assert opsim("merge", "a", "b", "-o", "merged")[0] == 0 and opsim("merge", "a", "b", "-o", "a")[0] == 0
    assert said(tmp_path / "merged") == said(tmp_path / "a") == found
    assert opsim("merge", "b", "merged", "-o", "merged")[0] == 0
    assert said(tmp_path / "merged") == found and hashes(tmp_path / "merged") == whole


def test_shards_in_one_folder_say_their_engine_each_and_together(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    for shard, engine in (("1/3", "fast"), ("2/3", "simpy"), ("3/3", "fast")):
        swept("-o", "s", "--shard", shard, "--engine", engine)
    assert [path.name for path in sorted((tmp_path / "s").glob("engine*"))] == [
        f"engine_shard_{n}_of_3.json" for n in (1, 3)
    ]
    assert opsim("merge", "s")[0] == 0
    assert said(tmp_path / "s") == {"asked": "fast, simpy", "used": BOTH}
    swept("-o", "s", "--overwrite", "--processes", 1)
    assert not [*(tmp_path / "s").glob("engine*")]


def test_a_study_that_goes_on_with_shards_says_their_engines(tmp_path, monkeypatch):
    stand_in(monkeypatch)
    swept("-o", "s", "--shard", "1/2", "--engine", "fast")
    swept("-o", "s", "--processes", 1)
    assert said(tmp_path / "s")["used"] == {"simpy": "which is the reference"}
    assert said(tmp_path / "s")["earlier"] == ["fast"]


def test_a_missing_shard_is_named_with_the_command_that_makes_it(tmp_path):
    swept("-o", "s", "--shard", "1/3", "--replications", 3, "--horizon", "30 min")
    code, _, err = opsim("merge", "s", "-o", "out")
    assert code == 2 and "6 of 9 replications are missing" in err and "shard 3/3 is not there" in err
    assert "opsim sweep line.yaml --replications 3 --horizon '30 min' --shard 2/3 -o s" in err
    assert not (tmp_path / "out").exists()


def test_an_unfinished_shard_and_a_damaged_line_are_named(tmp_path):
    for shard in ("1/2", "2/2"):
        swept("-o", "s", "--shard", shard)
    path = tmp_path / "s" / "answers" / "shard_2_of_2.jsonl"
    path.write_bytes(path.read_bytes().replace(b", 1, -1,", b", 7, -1,", 1))
    code, _, err = opsim("merge", "s")
    assert code == 2 and "shard 2/2 is not finished, 1 of" in err and "shard_2_of_2.jsonl:2 is damaged" in err
    swept("-o", "s", "--shard", "2/2")
    assert opsim("merge", "s")[0] == 0


@pytest.mark.parametrize(
    ("other", "says"),
    [
        (("--seed", 9), "seed 3, now 9"),
        (("--replications", 3), "replications"),
        (("--horizon", "9 min"), "the scenario"),
    ],
)
def test_shards_of_other_studies_are_not_merged(tmp_path, other, says):
    swept("-o", "a", "--shard", "1/2")
    swept("-o", "b", "--shard", "2/2", *other)
    code, _, err = opsim("merge", "a", "b", "-o", "out")
    assert code == 2 and "b is not of the same study as a" in err and says in err and not (tmp_path / "out").exists()


def test_a_scenario_that_has_changed_since_or_gone_is_refused_at_merge(tmp_path):
    swept("-o", "s", "--shard", "1/1")
    line(tmp_path, STUDY.replace("fixed: 25 s", "fixed: 26 s"))
    clear()
    code, _, err = opsim("merge", "s")
    assert code == 2 and "made from something else" in err and not (tmp_path / "s" / "summary.json").exists()
    line(tmp_path, STUDY, "moved.yaml")
    (tmp_path / "line.yaml").unlink()
    clear()
    assert opsim("merge", "s")[0] == 2
    assert opsim("merge", "s", "--file", "moved.yaml")[0] == 0


def clear():
    from opsim.study.jobs import evaluate
    from opsim.study.jobs import evaluate as decides

    decides._made_from.cache_clear()
    evaluate._variant.cache_clear()


def test_shards_that_disagree_are_refused(tmp_path):
    for folder in ("a", "b"):
        swept("-o", folder, "--shard", "1/1")
    held = Journal([tmp_path / "b" / "answers" / "shard_1_of_1.jsonl"])
    first = next(iter(held))
    lie = Answer.of([Figure(*key, value + 1) for key, value in zip(held.keys(first), held.values(first))])
    held.close()
    forged = Journal(own=tmp_path / "b" / "answers" / "all.jsonl")
    forged.add(first, lie)
    forged.close()
    code, _, err = opsim("merge", "a", "b", "-o", "out")
    assert code == 2 and "other answers to the same replication" in err and not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("--shard", "9/8"), "from 1 to 8"),
        (("--shard", "x"), "such as 2/8"),
        (("--executor", "dask:nowhere"), "expected dask:tcp://HOST:PORT"),
        (("--executor", "dask:tcp://127.0.0.1:1"), "no scheduler answers there"),
        (("--executor", "spark"), "expected dask:ADDRESS"),
        (("--scenario", "bass"), "did you mean 'base'"),
        (("-o", "line.yaml"), "is a file, not a folder"),
        (("-o", "line.yaml/below"), "Not a directory"),
        (("-o", "/proc/nowhere/below"), "No such file"),
        (("--horizon", "5 kg"), "run.horizon"),
    ],
)
def test_what_is_wrong_is_said_before_anything_is_computed(tmp_path, words, says):
    code, _, err = opsim("sweep", "line.yaml", *words)
    assert code == 2 and says in err and "sweep: 1 of" not in err
    assert not (tmp_path / "results").exists()


def test_a_kind_whose_jobs_are_not_known_beforehand_has_no_shards(monkeypatch):
    kind = SimpleNamespace(**{**vars_of(made_study.KIND), "no_shards": "what is run next depends on what was found"})
    monkeypatch.setattr(made_study, "KIND", kind)
    code, _, err = opsim("sweep", "line.yaml", "--shard", "1/2")
    assert code == 2 and "--shard: what is run next depends" in err


def vars_of(kind):
    return {name: getattr(kind, name) for name in ("name", "study", "kept", "no_shards")}


def test_a_full_disk_is_said_and_what_is_finished_is_gone_on_with(tmp_path, monkeypatch, whole):
    write, calls = os.write, []

    def full(file, line):
        calls.append(1)
        if len(calls) > 4:
            raise OSError(28, "No space left on device")
        return write(file, line)

    monkeypatch.setattr(os, "write", full)
    code, _, err = opsim("sweep", "line.yaml", "-o", "s", "--processes", 1)
    assert code == 2 and "all.jsonl: No space left on device" in err
    monkeypatch.setattr(os, "write", write)
    _, _, err = opsim("sweep", "line.yaml", "-o", "s", "--processes", 1)
    assert "of 3" in err and hashes(tmp_path / "s") == whole


def test_two_runs_into_one_folder_are_refused(tmp_path):
    from opsim.study.results_folder import locked

    swept("-o", "s")
    with locked(tmp_path / "s" / "answers" / ".all.jsonl.lock", ""):
        code, _, err = opsim("sweep", "line.yaml", "-o", "s")
        assert code == 2 and "another run writes to all.jsonl now" in err
        assert opsim("sweep", "line.yaml", "-o", "s", "--overwrite")[0] == 2


def test_runs_and_studies_are_not_mixed(tmp_path):
    swept("-o", "s")
    before = sorted(path.name for path in (tmp_path / "s").iterdir())
    for more in ((), ("--overwrite",)):
        code, _, err = opsim("run", "line.yaml", "-o", "s", *more)
        assert code == 2 and "holds a study" in err
    assert sorted(path.name for path in (tmp_path / "s").iterdir()) == before
    (tmp_path / "r" / "base").mkdir(parents=True)
    (tmp_path / "r" / "base" / "manifest.json").write_text("{}")
    code, _, err = opsim("sweep", "line.yaml", "-o", "r", "--overwrite")
    assert code == 2 and "opsim run" in err and not (tmp_path / "r" / "study.json").exists()


def test_a_study_that_finds_at_its_first_answer_that_it_is_wrong_leaves_none_behind(tmp_path, monkeypatch):
    def wrong(asked, answers):
        answers.ensure([made_study.Job(made_study.points()[0], 0)])
        raise ValueError("no such figure")

    monkeypatch.setattr(made_study, "KIND", SimpleNamespace(**{**vars_of(made_study.KIND), "study": wrong}))
    assert opsim("sweep", "line.yaml", "-o", "s")[2].endswith("no such figure\n")
    monkeypatch.undo()
    monkeypatch.chdir(tmp_path)
    assert not (tmp_path / "s" / "study.json").exists() and not list((tmp_path / "s").rglob("*.jsonl"))


def test_a_study_that_is_wrong_leaves_no_study_behind(tmp_path, monkeypatch):
    monkeypatch.setattr(made_study, "BUFFERS", (1, -1))
    code, _, err = opsim("sweep", "line.yaml", "-o", "s")
    assert (
        code == 2
        and "-1" in err
        and not [path for path in (tmp_path / "s").rglob("*") if path.suffix != ".lock" and path.is_file()]
    )


def test_merge_asks_for_folders_and_where_to(tmp_path):
    swept("-o", "s", "--shard", "1/1")
    assert "where the whole study goes" in opsim("merge", "s", "s")[2]
    assert "is to be merged" in opsim("merge", "s", "--overwrite")[2]
    assert "no study here" in opsim("merge", "nowhere", "-o", "out")[2]
    (tmp_path / "s" / "study.json").write_text('{"opsim_study": 1}')
    code, _, err = opsim("merge", "s")
    assert code == 2 and "study.json" in err


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
