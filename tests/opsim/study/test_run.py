"""When more than one process is used. The rows are the same either way: tests/opsim/study/test_run.py."""

import json
import pickle
import shutil
import tracemalloc
from pathlib import Path
from shutil import copy, copytree

import numpy as np
import pytest
from plans import CELL, line, loaded, queue

from opsim.kpi import Figure
from opsim.log import CREATE, FINISH, JOIN, SCRAP, event_log, row
from opsim.log_parquet import connect, read_events
from opsim.scenario import read_scenarios
from opsim.shipped import shipped_folder
from opsim.study import replication as replicating
from opsim.study import run_scenario
from opsim.study.long_run.warm_up import finished_per_h, jobs_inside, mser, suggested_warm_up
from opsim.study.replication import MOST_SAMPLES, Figures, Replicated, Together, thinned, together
from opsim.study.results_folder import LOCK, Busy, locked
from opsim.study.run import reopened
from opsim.study.summary import _distribution


def files(folder):
    return {path.name: path.read_bytes() for path in sorted((folder / "events").iterdir())}


@pytest.fixture(scope="module")
def one(tmp_path_factory):
    folder = tmp_path_factory.mktemp("one")
    return run_scenario(loaded(CELL), folder=folder, processes=1)


def test_one_and_two_processes_write_the_same_bytes(one, tmp_path):
    two = run_scenario(loaded(CELL), folder=tmp_path, processes=2)
    assert files(two.folder) == files(one.folder) and len(files(one.folder)) == 3
    assert two.summary == one.summary


def test_the_folder_holds_what_the_design_promises(one):
    names = {path.name for path in one.folder.iterdir()}
    shown = {"scenario.resolved.yaml", "manifest.json", "events", "kpis.parquet", "summary.json", "finished.json"}
    assert names == {*shown, ".run.lock"}
    assert [path.name for path in one.events_files] == [f"replication_{r:05d}.parquet" for r in range(3)]


def test_the_resolved_scenario_reads_as_the_same_scenario(one):
    again = loaded((one.folder / "scenario.resolved.yaml").read_text())
    assert again.scenario == loaded(CELL).scenario


def test_means_in_the_summary_are_means_of_the_kpi_table(one):
    with connect() as connection:
        table = connection.execute(
            f"SELECT kpi, subject, part, avg(value) FROM '{one.folder / 'kpis.parquet'}' GROUP BY ALL"
        ).fetchall()
    expected = {(row["kpi"], row["subject"], row["part"]): row["mean"] for row in one.summary["kpis"]}
    assert {tuple(key): pytest.approx(mean) for *key, mean in table} == expected


def test_a_killed_run_goes_on_where_it_stopped(one, tmp_path, monkeypatch):
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, replications=2)
    ran = []
    run_one = replicating.run_one
    monkeypatch.setattr(
        replicating,
        "run_one",
        lambda plan, r, folder, *more: (
            ran.append(replicating.events_file(folder, r).exists()) or run_one(plan, r, folder, *more)
        ),
    )
    finished = run_scenario(loaded(CELL), folder=tmp_path, processes=1)
    assert ran == [True, True, False]
    assert finished.summary == one.summary


def test_rows_that_cannot_be_read_or_are_of_another_run_are_made_anew(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    first, second, third = (tmp_path / "copy" / "events" / name for name in files(one.folder))
    first.write_bytes(b"")
    second.write_bytes(second.read_bytes()[:500])
    third.write_bytes((one.folder / "events" / first.name).read_bytes())
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary
    assert files(tmp_path / "copy") == files(one.folder)


def test_rows_of_another_seed_are_not_taken_for_those_asked_for(one, tmp_path):
    other = run_scenario(loaded(CELL), folder=tmp_path / "other", processes=1, seed=99, replications=1)
    shutil.copytree(one.folder, tmp_path / "copy")
    shutil.copy(other.events_files[0], tmp_path / "copy" / "events")
    run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1)
    assert files(tmp_path / "copy") == files(one.folder)


def test_fewer_replications_give_the_results_of_the_first_and_keep_the_other_rows(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    fewer = run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, replications=2)
    assert fewer.summary["replications"] == 2 and len(fewer.events_files) == 2
    assert files(tmp_path / "copy") == files(one.folder)


def test_times_that_are_all_the_same_and_huge_have_a_histogram():
    row = _distribution("duration_s", "long", np.full(7, 5e9))
    assert sum(row["histogram"]["counts"]) == 7 and np.all(np.diff(row["histogram"]["edges"]) > 0)


def test_progress_counts_every_replication(tmp_path):
    seen = []
    run_scenario(loaded(CELL), folder=tmp_path, processes=1, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_replications_differ_and_are_numbered(one):
    logs = [read_events(path) for path in one.events_files]
    assert [log.replication for log in logs] == [0, 1, 2]
    assert len({tuple(log["end_s"][:50]) for log in logs}) == 3


def test_what_was_not_measured_is_on_the_assumption_sheet(one):
    says = " ".join(f"{a['topic']}: {a['says']}" for a in one.summary["assumptions"])
    for words in (
        "not from recordings",
        "ana, cai: walking speed not given",
        "transport: jobs pass",
        "nearest (chosen)",
        "same people",
    ):
        assert words in says


@pytest.mark.parametrize(
    "run, how, says",
    [
        ("seed: 5", {"replications": 1}, ["replications: 1, given with the call; the file says nothing"]),
        (
            "replications: 3, seed: 5",
            {"replications": 1},
            ["replications: 1, given with the call; instead of the file's 3"],
        ),
        ("replications: 1", {"seed": 9}, ["seed: 9, given with the call; the file says nothing"]),
        ("replications: 1", {}, ["seed: 0, the default"]),
        ("replications: 1, seed: 5", {"seed": 5}, []),
    ],
)
def test_the_assumption_sheet_says_where_seed_and_replications_come_from(tmp_path, run, how, says):
    text = CELL.replace("horizon: 2 h", "horizon: 20 min").replace("replications: 3, seed: 5", run)
    found = run_scenario(loaded(text), folder=tmp_path, processes=1, **how).summary["assumptions"]
    found = [line["says"] for line in found if line["topic"] == "run"]
    assert len(found) == len(says) and all(words in line for words, line in zip(says, found))


def test_the_manifest_names_seed_and_versions(one):
    manifest = json.loads((one.folder / "manifest.json").read_text())
    assert manifest["seed"] == 5 and manifest["packages"]["simpy"]


def test_a_finished_run_is_taken_as_it_is_and_no_row_is_read(one, tmp_path, monkeypatch):
    shutil.copytree(one.folder, tmp_path / "copy")
    monkeypatch.setattr(replicating, "run_one", None)
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary


@pytest.mark.parametrize(
    "spoil",
    [
        lambda folder: (folder / "kpis.parquet").write_bytes(b"PAR1"),
        lambda folder: (folder / "summary.json").write_text("{}"),
        lambda folder: (folder / "finished.json").write_text("[]"),
        lambda folder: (folder / "events" / "replication_00001.parquet").unlink(),
    ],
    ids=["figures", "summary", "what it says", "rows"],
)
def test_results_that_are_not_whole_are_made_anew_of_the_rows(one, tmp_path, spoil):
    shutil.copytree(one.folder, tmp_path / "copy")
    spoil(tmp_path / "copy")
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary
    for name in ("kpis.parquet", "summary.json", "finished.json"):
        assert (tmp_path / "copy" / name).read_bytes() == (one.folder / name).read_bytes()
    assert files(tmp_path / "copy") == files(one.folder)


def test_other_options_or_outputs_of_the_same_rows_are_another_run(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    assert (
        run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, replications=2).summary["replications"] == 2
    )
    other = loaded(CELL.replace("warm_up: 10 min", "warm_up: 5 min"))
    assert run_scenario(other, folder=tmp_path / "copy", processes=1).summary["window_s"][0] == 300
    assert files(tmp_path / "copy") == files(one.folder)
    assert run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1).summary == one.summary


def test_two_runs_do_not_write_into_one_folder(one, tmp_path):
    shutil.copytree(one.folder, tmp_path / "copy")
    before = {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()}
    with locked(tmp_path / "copy" / LOCK, ""), pytest.raises(Busy, match="another 'opsim run' writes there now"):
        run_scenario(loaded(CELL), folder=tmp_path / "copy", processes=1, overwrite=True)
    assert {path: path.read_bytes() for path in (tmp_path / "copy").rglob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    ("took_s", "at_home"),
    [
        ((0.1,), 20),
        ((1.5, 0.1), 20),
        ((1.5, 1.4), 2),
        ((9.0,), 1),
    ],
    ids=["quick", "only the first is slow: it loads", "all are slow", "so slow that no second is asked"],
)
def test_processes_are_started_where_the_work_left_is_worth_it(took_s, at_home, monkeypatch):
    clock, alone, pooled = [0.0], [], []
    pace = iter([*took_s, *[took_s[-1]] * 20])

    def run(replication):
        alone.append(replication)
        clock[0] += next(pace)
        return replication

    monkeypatch.setattr(replicating.time, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(replicating, "cores", lambda: 2)
    monkeypatch.setattr(replicating, "pays", lambda seconds: seconds > 4)
    monkeypatch.setattr(replicating, "pooled", lambda runner, left, processes, meanwhile: pooled.extend(left) or left)
    assert list(replicating._results(lambda: run, range(20), None)) == list(range(20))
    assert alone == list(range(at_home)) and pooled == list(range(at_home, 20))


@pytest.mark.parametrize("processes", [1, 2])
def test_a_number_of_processes_that_is_asked_for_is_taken(processes, monkeypatch):
    used = []
    monkeypatch.setattr(replicating, "pooled", lambda runner, left, n, meanwhile: used.append(n) or left)
    assert list(replicating._results(lambda: lambda replication: replication, range(3), processes)) == [0, 1, 2]
    assert used == ([2] if processes == 2 else [])


KEYS = [("worker_states", f"worker {n}", part, "share") for n in range(20) for part in ("work", "walk", "idle")]


def replication(number, size=500):
    rng = np.random.default_rng(number)
    figures = [Figure(*key, value) for key, value in zip(KEYS, rng.normal(size=len(KEYS)).tolist())]
    return Replicated(number, Figures.of(figures), {("time_in_system_s", ""): rng.exponential(size=size)})


def test_figures_are_what_they_were_made_of_also_after_they_were_sent():
    listed = [Figure("throughput_per_h", "", "", "1/h", 3.5), Figure("worker_states", "ana", "work", "share", np.nan)]
    for found in (Figures.of(listed), pickle.loads(pickle.dumps(Figures.of(listed)))):
        assert len(found) == 2 and found[0] == listed[0] and found[-1][:4] == listed[1][:4]
        assert [figure[:4] for figure in found] == [figure[:4] for figure in listed] and np.isnan(found[1].value)


def test_few_values_stay_as_they_came():
    done = [replication(number) for number in (2, 0, 1)]
    kept = together(done)
    assert [one.replication for one in kept] == [0, 1, 2]
    assert all(np.array_equal(one.samples["time_in_system_s", ""], of) for one, of in zip(kept, map(values, range(3))))


def values(number):
    return replication(number).samples["time_in_system_s", ""]


@pytest.mark.parametrize("seed", range(5))
def test_what_is_kept_does_not_depend_on_the_order_they_come_in(seed):
    rng = np.random.default_rng(seed)
    sizes = rng.integers(0, 3000, 40)
    kept = Together(most=5000)
    for number in rng.permutation(40).tolist():
        kept.add(replication(number, sizes[number]))
    again = Together(most=5000)
    for number in range(40):
        again.add(replication(number, sizes[number]))
    left = [[one.samples["time_in_system_s", ""] for one in of.in_order()] for of in (kept, again)]
    assert all(np.array_equal(one, other) for one, other in zip(*left))
    assert 2000 < sum(of.size for of in left[0]) <= 5000


def test_thinned_values_are_spread_as_all_are():
    kept = Together(most=10_000)
    for number in range(200):
        kept.add(replication(number))
    pooled = np.concatenate([one.samples["time_in_system_s", ""] for one in kept.in_order()])
    whole = np.concatenate([values(number) for number in range(200)])
    of = np.linspace(0.05, 0.95, 19)
    assert np.allclose(np.quantile(pooled, of), np.quantile(whole, of), rtol=0.05, atol=0.01)
    assert np.allclose(np.quantile(thinned(whole, MOST_SAMPLES), of), np.quantile(whole, of), rtol=1e-3)


def test_another_replication_takes_its_figures_and_some_names_only():
    """60 figures are 480 bytes; 500 values of a sample would be 4,000, of which few are kept once there are many."""
    sent = [pickle.dumps(replication(number)) for number in range(160)]
    kept = Together(most=2_000)
    for one in sent[:60]:
        kept.add(pickle.loads(one))
    tracemalloc.start()
    for one in sent[60:]:
        kept.add(pickle.loads(one))
    grown, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert grown / 100 < 2000


LIBRARY = "libraries/bench_work.npz"
TEXT = f"""
opsim: 1
name: Bench
run: {{horizon: 10 min, replications: 2, seed: 5}}
libraries: {{work: {LIBRARY}}}
layout: {{places: {{bench: [0 m, 0 m]}}}}
tasks: {{reach: {{emulator: work/reach}}}}
stations: {{bench: {{at: bench, tasks: [reach]}}}}
products: {{part: {{route: [bench]}}}}
release: {{kind: poisson, every: 20 s}}
workers: {{ana: {{skills: {{bench: 1.0}}}}}}
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A run whose library is the user's own."""
    home = tmp_path_factory.mktemp("bench")
    (home / "libraries").mkdir()
    copy(shipped_folder() / LIBRARY, home / LIBRARY)
    (home / "bench.yaml").write_text(TEXT)
    run_scenario(read_scenarios(home / "bench.yaml")["base"], folder=home / "base", processes=1, seed=11)
    return home


def test_the_plan_and_the_rows_are_those_of_the_run(made):
    again = reopened(made / "base")
    assert (again.plan.seed, again.loaded.variant, again.result.summary["seed"]) == (11, "base", 11)
    for replication in range(2):
        rows = read_events(made / "base" / "events" / f"replication_{replication:05d}.parquet")
        assert all(np.array_equal(again.log(replication)[name], rows[name], equal_nan=True) for name in rows.columns)


def test_a_replication_that_was_not_run_is_refused_with_those_there_are(made):
    with pytest.raises(ValueError, match=r"replication 2: .* holds 0 to 1"):
        reopened(made / "base").log(2)


def test_another_library_than_that_of_the_run_is_refused(made, tmp_path):
    folder = Path(copytree(made / "base", tmp_path / "base"))
    with (folder / LIBRARY).open("ab") as library:
        library.write(b"\0")
    with pytest.raises(ValueError, match="the library work has changed"):
        reopened(folder)


def test_a_folder_without_a_run_is_an_error_in_words(tmp_path):
    with pytest.raises(OSError):
        reopened(tmp_path)


def naive_mser(series, batch=5):
    means = [np.mean(series[i : i + batch]) for i in range(0, len(series) // batch * batch, batch)]
    score = [np.sum((means[d:] - np.mean(means[d:])) ** 2) / (len(means) - d) ** 2 for d in range(len(means) - 4)]
    best = int(np.argmin(score))
    return None if best > len(means) / 2 else best * batch


def test_a_step_is_cut_off_where_it_ends():
    assert mser(np.r_[np.full(60, 9.0), np.tile([1.0, 2.0, 1.5, 1.0, 2.0], 60) + np.repeat(np.arange(60) % 2, 5)]) == 60


def test_a_steady_series_needs_no_warm_up():
    assert mser(np.full(200, 3.0)) == 0
    assert mser(np.tile(np.arange(10.0), 40)) == 0


def test_a_series_that_never_settles_is_refused():
    assert mser(np.r_[np.arange(300.0), np.full(100, 299.0) + np.arange(100) % 2]) is None


@pytest.mark.parametrize("seed", range(20))
def test_it_is_the_naive_statistic(seed):
    rng = np.random.default_rng(seed)
    series = 1e6 + np.exp(-np.arange(403) / rng.uniform(5, 80)) * rng.normal(0, 30) + rng.normal(size=403)
    assert mser(series) == naive_mser(series)


def test_cutting_brings_the_mean_of_an_autoregression_nearer_to_the_truth():
    """AR(1), 300 series of 1,000, begun 17 standard deviations off: squared error about 0.26 whole, 0.10 at best."""
    rng = np.random.default_rng(7)
    state, values = np.full(300, 40.0), []
    for _ in range(1000):
        state = 0.9 * state + rng.normal(size=300)
        values.append(state)
    series = np.array(values).T
    cut = np.array([one[mser(one) :].mean() for one in series])
    assert np.mean(cut**2) < 0.6 * np.mean(series.mean(axis=1) ** 2)


def test_too_few_or_unknown_values_are_refused():
    with pytest.raises(ValueError, match="too few"):
        mser(np.ones(99))
    with pytest.raises(ValueError, match="not finite"):
        mser(np.r_[np.ones(200), np.nan])


def test_series_of_a_log_are_those_counted_by_hand():
    rows = [row(CREATE, 0, 0, job=0), row(CREATE, 10, 10, job=1), row(FINISH, 25, 25, job=0)]
    names = dict.fromkeys(("worker", "station", "source", "product", "operation", "task"), ("a",))
    log = event_log(rows, 40.0, names)
    edges = np.array([0.0, 20.0, 40.0])
    assert jobs_inside(log, edges) == pytest.approx([1.5, 1.25])
    assert finished_per_h(log, edges) == pytest.approx([0, 180])


def test_parts_that_are_joined_and_jobs_that_are_scrapped_are_inside_no_longer():
    rows = [*(row(CREATE, 0, 0, job=job) for job in range(3)), row(JOIN, 10, 10, job=0), row(SCRAP, 20, 20, job=1)]
    names = dict.fromkeys(("worker", "station", "source", "product", "operation", "task"), ("a",))
    assert jobs_inside(event_log(rows, 40.0, names), np.array([0.0, 20.0, 40.0])) == pytest.approx([2.5, 1.0])


def test_the_series_of_a_queue_settles_and_its_steady_mean_is_that_of_theory(tmp_path):
    text = queue(horizon="4000 s", warm_up="0 s", every="2 s").replace("seed: 1", "seed: 3, replications: 5")
    inside, out = suggested_warm_up(run_scenario(loaded(text), folder=tmp_path, processes=1))
    assert inside.until_s is not None and inside.until_s <= 1000
    assert inside.series.mean() == pytest.approx(1.0, rel=0.1)  # load 1/2: L = 1
    assert inside.series.size == 500 and inside.slice_s == 8
    assert out.until_s is not None and out.series.mean() == pytest.approx(1800, rel=0.05)


def test_a_line_that_has_to_fill_first_is_cut_while_it_fills(tmp_path):
    """The bottleneck is last: 30 places before it fill at the difference of the rates, 1/1 - 1/1.5 a second: 90 s."""
    text = line(2, 30, horizon="3000 s", warm_up="0 s").replace("seed: 1", "seed: 1, replications: 5")
    text = text.replace("t2: {dist: exponential, mean: 1 s}", "t2: {dist: exponential, mean: 1.5 s}")
    inside, _ = suggested_warm_up(run_scenario(loaded(text), folder=tmp_path, processes=1))
    assert 60 <= inside.until_s <= 240
