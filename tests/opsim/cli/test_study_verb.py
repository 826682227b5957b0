"""A study as its user runs it: gone on with, split, merged, refused; with a made study instead of a real one."""

import hashlib
import json
import os
import shutil
from types import SimpleNamespace

import pytest
from stand_in_engine import stand_in

from opsim.kpi.catalogue import Figure
from opsim.study.jobs.job import Answer
from opsim.study.jobs.journal import Journal
from tests.made import study as made_study
from tests.opsim.cli.calls import LINE, line, opsim

STUDY = LINE + "studies: {sweep: {vary: {stations.saw.buffer: [1, 2, 4]}}}\n"
BYTES = ("summary.json", "figures.parquet", "sweep.html", "study.json")


@pytest.fixture(autouse=True)
def in_folder(tmp_path, monkeypatch):
    stand_in_folder(tmp_path, monkeypatch)


def stand_in_folder(folder, patch):
    patch.chdir(folder)
    patch.setattr("opsim.cli.sweep.KIND", made_study.KIND, raising=False)
    patch.setattr("opsim.cli.sweep.command", made_study.command)
    line(folder, STUDY)


def hashes(folder):
    return [hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in BYTES]


def swept(*words):
    code, out, err = opsim("sweep", "line.yaml", *words)
    assert code == 0, err
    return out


@pytest.fixture(scope="module")
def whole_once(tmp_path_factory):
    """The folder of the whole study, which no test changes."""
    folder = tmp_path_factory.mktemp("study")
    with pytest.MonkeyPatch.context() as patch:
        stand_in_folder(folder, patch)
        swept("-o", "whole", "--processes", 1)
    return folder / "whole"


@pytest.fixture
def whole(whole_once, tmp_path):
    """Its hashes; a copy of it stands in the test's folder."""
    return hashes(shutil.copytree(whole_once, tmp_path / "whole"))


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
