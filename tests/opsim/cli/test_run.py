"""Which rows of a run the console shows.

A floor that locks itself: ``check`` flags it before the run, and the run names the circle.
"""

import json
from dataclasses import dataclass

import pytest

from opsim.cli.app import print_json, print_table
from opsim.cli.progress import progress
from opsim.cli.run import matters, print_results, without_repeats
from opsim.engine.endless import EndlessInstant
from opsim.laws.audit import BrokenLog
from opsim.pool import ProcessLost
from tests.made.result import kpi
from tests.opsim.cli.calls import LINE, line, opsim

TWO = LINE + "overrides: {wide: {stations.press.servers: 2}}\nscenarios: {base: [], wider: [wide]}\n"


def test_run_prints_a_column_a_variant_and_where_the_reports_are(tmp_path):
    code, shown, progress = opsim("run", line(tmp_path, TWO), "-o", tmp_path / "out")
    assert code == 0
    assert "base" in shown and "wider" in shown and "Throughput" in shown and "±" in shown
    assert f"report wider: {tmp_path / 'out' / 'wider' / 'report.html'}" in shown
    assert "run base: 2 of 2" in progress
    assert (tmp_path / "out" / "base" / "report.html").stat().st_size > 1e6


def test_run_as_json_is_json(tmp_path):
    code, shown, _ = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--json")
    (result,) = json.loads(shown)["results"]
    assert code == 0
    assert result["summary"]["replications"] == 2 and result["report"].endswith("report.html")


def test_only_the_named_variant_is_run(tmp_path):
    opsim("run", line(tmp_path, TWO), "-o", tmp_path / "out", "--scenario", "wider")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["wider"]


def test_replications_seed_and_horizon_of_the_call_replace_those_of_the_file(tmp_path):
    words = ("--replications", 1, "--seed", 9, "--horizon", "10 min", "--json")
    _, shown, _ = opsim("run", line(tmp_path), "-o", tmp_path / "out", *words)
    summary = json.loads(shown)["results"][0]["summary"]
    assert (summary["replications"], summary["seed"], summary["window_s"]) == (1, 9, [0, 600])
    assert "10 min" in (tmp_path / "out" / "base" / "scenario.resolved.yaml").read_text()


def test_the_default_folder_carries_the_name_of_the_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    opsim("run", line(tmp_path), "--replications", 1)
    assert (tmp_path / "results" / "line" / "base" / "summary.json").is_file()


@pytest.mark.parametrize("horizon, said", [("10", "unit"), ("8 hours", "h"), ("-5 min", "horizon"), ("x", "time")])
def test_a_wrong_horizon_is_a_mistake(tmp_path, horizon, said):
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--horizon", horizon)
    assert code == 2 and said in complaint


def test_a_folder_that_cannot_be_written_is_a_mistake(tmp_path):
    (tmp_path / "out").write_text("a file, not a folder")
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 2 and "out" in complaint


def test_control_c_leaves_with_130_and_says_what_is_kept(tmp_path, monkeypatch):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("opsim.study.run_scenario", stopped)
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 130 and "finished replications are kept in" in complaint


def test_a_folder_of_another_run_is_refused_before_anything_is_run(tmp_path):
    words = ("run", line(tmp_path, TWO), "-o", tmp_path / "out", "--replications", 1)
    opsim(*words)
    code, _, complaint = opsim(*words, "--seed", 8)
    assert code == 2 and "base holds 1 replication" in complaint and "wider holds 1 replication" in complaint
    assert "seed 3, now 8" in complaint and "--overwrite" in complaint
    assert opsim(*words)[0] == 0
    assert opsim(*words, "--seed", 8, "--overwrite")[0] == 0


@pytest.mark.parametrize(
    "error, said",
    [
        (BrokenLog("replication 1: job 3 is gone twice"), "mistake in opsim"),
        (EndlessInstant("t = 0 s: over 10000 rounds"), "does not move on in time"),
        (ProcessLost("a process was killed (out of memory?)"), "try --processes 1"),
        (MemoryError(), "out of memory"),
    ],
)
def test_what_is_nobodys_mistake_in_the_file_is_said_in_words_with_exit_code_1(tmp_path, monkeypatch, error, said):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr("opsim.study.run_scenario", fails)
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out")
    assert code == 1 and said in complaint and "finished replications are kept in" in complaint


def test_a_wanted_precision_decides_the_number_of_replications(tmp_path):
    words = ("run", line(tmp_path), "-o", tmp_path / "out", "--precision", "throughput_per_h=5%")
    code, shown, _ = opsim(*words)
    assert code == 0 and "throughput_per_h is known within" in shown and "wanted: 5 %" in shown
    code, shown, _ = opsim(*words, "--replications", 2)
    assert code == 0 and "after 2 replications" in shown and "not reached" in shown


@pytest.mark.parametrize(
    "wanted, said", [("throughput=1%", "throughput_per_h"), ("throughput_per_h/x=1%", "no figure"), ("x", "PER CENT")]
)
def test_a_wrong_precision_is_a_mistake(tmp_path, wanted, said):
    code, _, complaint = opsim("run", line(tmp_path), "-o", tmp_path / "out", "--precision", wanted)
    assert code == 2 and said in complaint


def test_a_bug_of_ours_is_not_dressed_up_as_a_mistake(tmp_path, monkeypatch):
    def broken(*_, **__):
        raise ValueError("a bug")

    monkeypatch.setattr("opsim.study.run_scenario", broken)
    with pytest.raises(AssertionError, match="a bug"):
        opsim("run", line(tmp_path), "-o", tmp_path / "out")


def test_repeated_names_of_a_figure_are_left_out():
    rows = [("A", "x"), ("A", "y"), ("B", "x")]
    assert without_repeats(rows) == [("A", "x"), ("", "y"), ("B", "x")]


def test_emulated_tasks_come_with_their_strips(tmp_path):
    words = ("--scenario", "base", "--replications", 1, "--horizon", "40 min", "-o", tmp_path / "out")
    code, _, _ = opsim("run", "repack_cell", *words)
    report = (tmp_path / "out" / "base" / "report.html").read_text(encoding="utf-8")
    strips = report.split("Movements behind the times")[-1].count("data:image/svg+xml;base64,")
    assert code == 0 and strips == 3


@dataclass
class Made:
    summary: dict


def result(*rows):
    return Made({"kpis": list(rows), "replications": 2, "seed": 1, "confidence": 0.95})


def states(figure, subject, **shares):
    return [kpi(figure, subject, part, "share", share, 0.01, headline=True) for part, share in shares.items()]


def test_every_state_that_takes_more_than_a_twentieth_somewhere_is_shown(capsys):
    base = states("station_states", "press", work=0.2, blocked=0.0, setup=0.6, pickup=0.01, starved=0.19)
    wide = states("station_states", "press", work=0.2, blocked=0.0, setup=0.01, pickup=0.07, starved=0.72)
    print_results("made", {"base": result(*base), "wide": result(*wide)})
    shown = capsys.readouterr().out
    assert all(f"press {state}" in shown for state in ("work", "blocked", "setup", "pickup"))
    assert "starved" not in shown and "60.0 ± 1.0 %" in shown


def test_a_state_that_takes_little_everywhere_is_left_to_the_report(capsys):
    print_results("made", {"base": result(*states("station_states", "press", work=0.9, setup=0.05, down=0.01))})
    shown = capsys.readouterr().out
    assert "press work" in shown and "setup" not in shown and "down" not in shown
    assert "State of station: 2 rows are not shown here" in shown


@pytest.mark.parametrize("part", ["setup", "walk", "held", "team", "tool"])
def test_of_workers_too(part):
    assert matters("worker_states", part, {"base": {"mean": 0.3}})
    assert not matters("worker_states", part, {"base": {"mean": 0.01}, "wide": {"mean": None}})


def test_idle_workers_are_what_the_shown_states_leave_and_are_said_to_be_left_out(capsys):
    print_results("made", {"base": result(*states("worker_states", "ana", work=0.1, wait=0.9, walk=0.0))})
    assert "State of worker: 1 row is not shown here (waiting, breaks, and" in capsys.readouterr().out


def test_of_work_broken_off_the_parts_there_are_in_any_variant_are_shown_in_plain_words(capsys):
    def rows(**per_h):
        found = [kpi("interruptions_per_h", "", "", "1/h", sum(per_h.values()), 0.0, headline=True)]
        return [
            *found,
            *(kpi("interruptions_per_h", "press", p, "1/h", v, 0.0, headline=True) for p, v in per_h.items()),
        ]

    some = {"base": result(*rows(by_another=0.0, open=0.0)), "wide": result(*rows(by_another=2.0, open=0.0))}
    print_results("made", some)
    shown = capsys.readouterr().out
    assert "press gone on with by another" in shown and "press not gone on with" not in shown
    print_results("made", {"base": some["base"]})
    assert "Work broken off" in (shown := capsys.readouterr().out) and "press" not in shown


def test_of_exposure_by_anything_what_there_is_at_least_is_shown_in_plain_words(capsys):
    def rows(kpi_, subject, **per_h):
        return [kpi(kpi_, subject, part, "min/h", mean, 0.1, headline=True) for part, mean in per_h.items()]

    by_task = rows("exposure_by_task", "lift", rula_from_5=3.0, rula_from_5_at_most=9.0, rula_from_7=0.0)
    everybody = rows("rula_from_5_min_per_h", "", at_most=9.0, worst=4.0)
    print_results("made", {"base": result(*by_task, *everybody)})
    shown = capsys.readouterr().out
    assert "lift RULA 5 or more" in shown and "RULA 5 or more, at most" not in shown and "RULA 7" not in shown
    assert "at most" in shown and "whoever has most" in shown


def test_at_most_is_shown_only_where_it_is_more_than_at_least_in_some_variant(capsys):
    def rows(ana, ben):
        found = [
            ("ana", "", 2.0),
            ("ana", "at_most", ana),
            ("ben", "", 3.0),
            ("ben", "at_most", ben),
            ("", "worst", 3.0),
        ]
        return [kpi("rula_from_5_min_per_h", of, part, "min/h", mean, 0.0, headline=True) for of, part, mean in found]

    print_results("made", {"base": result(*rows(2.0, 3.0)), "open": result(*rows(2.0, 5.0))})
    shown = capsys.readouterr().out
    assert "ben at most" in shown and "ana at most" not in shown and "whoever has most" in shown


LOCKS = """
opsim: 1
name: One fixture for two machines
run: {horizon: 1 h, replications: 1, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {do: {fixed: 30 s, automatic: true}}
tools: {fixture: {n: 1}}
stations:
  cut: {at: here, tasks: [do], buffer: 1, needs: {fixture: 1}}
  drill: {at: here, tasks: [do], buffer: 0, needs: {fixture: 1}}
products: {part: {route: [cut, drill]}}
release: {kind: saturated}
outputs: [throughput_per_h]
"""


def test_check_flags_what_the_run_then_names(tmp_path):
    path = line(tmp_path, LOCKS)
    code, _, warned = opsim("check", path)
    assert code == 0 and "warning: base: jobs may wait for each other for ever: fixture is held at cut" in warned
    code, shown, told = opsim("run", path, "-o", tmp_path / "out")
    assert code == 0 and "the floor locked itself in 1 of 1 replications" in shown + told
    assert "cut" in told + shown and "drill" in told + shown and "fixture" in told + shown


def test_a_fixture_each_does_not_lock(tmp_path):
    text = LOCKS.replace(
        "drill: {at: here, tasks: [do], buffer: 0, needs: {fixture: 1}}", "drill: {at: here, tasks: [do], buffer: 0}"
    )
    path = line(tmp_path, text)
    assert "for ever" not in opsim("check", path)[2]
    code, shown, told = opsim("run", path, "-o", tmp_path / "out")
    assert code == 0 and "locked" not in shown + told


def test_elsewhere_than_on_a_terminal_progress_is_plain_lines(capsys):
    with progress("run base") as report:
        for done in range(1, 101):
            report(done, 100)
    assert capsys.readouterr().err.splitlines()[-1] == "run base: 100 of 100"


def test_quick_steps_do_not_flood_the_log(capsys):
    with progress("run base") as report:
        for done in range(1, 1001):
            report(done, 1000)
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_each_label_is_told_apart(capsys):
    with progress("fit lift") as report:
        report(3, 3, "aligning")
        report(2, 2, "judging")
    assert capsys.readouterr().err == "fit lift: aligning: 3 of 3\nfit lift: judging: 2 of 2\n"


def test_the_time_left_counts_from_the_start_and_not_from_the_first_step(monkeypatch, capsys):
    now = iter([100.0, 110.0])
    monkeypatch.setattr("opsim.cli.progress.time.monotonic", lambda: next(now))
    with progress("run base") as report:
        report(1, 3)
    assert capsys.readouterr().err == "run base: 1 of 3, 20 s left\n"


def times(monkeypatch, *at_s):
    now = iter(at_s)
    monkeypatch.setattr("opsim.cli.progress.time.monotonic", lambda: next(now))


def test_a_label_that_names_the_next_step_leaves_the_clock_alone(monkeypatch, capsys):
    times(monkeypatch, 100.0, 100.0, 120.0)
    with progress("judge") as report:
        report(0, 5, "reach: fitting")
        report(1, 5, "reach: two levels")
    assert capsys.readouterr().err == "judge: reach: fitting: 0 of 5\njudge: reach: two levels: 1 of 5, 80 s left\n"


def test_a_label_that_counts_anew_has_a_clock_of_its_own_and_promises_nothing_at_first(monkeypatch, capsys):
    times(monkeypatch, 100.0, 150.0, 160.0, 170.0)
    with progress("fit") as report:
        report(3, 3, "aligning")
        report(1, 4, "judging")
        report(2, 4, "judging")
    assert capsys.readouterr().err.splitlines()[1:] == ["fit: judging: 1 of 4", "fit: judging: 2 of 4, 20 s left"]


def test_nothing_done_yet_promises_no_time(capsys):
    with progress("run base") as report:
        report(0, 5)
    assert capsys.readouterr().err == "run base: 0 of 5\n"


def test_a_terminal_gets_a_bar(monkeypatch, capsys):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with progress("run [red]base") as report:
        report(1, 2, "half")
    assert "Traceback" not in capsys.readouterr().err


def test_names_in_a_table_are_never_markup(capsys):
    print_table("[red]title", ("a", "b"), [("[bold]x[/bold]", "1")])
    shown = capsys.readouterr().out
    assert "[red]title" in shown and "[bold]x[/bold]" in shown


def test_what_is_not_a_number_is_null_in_json(capsys):
    print_json({"a": float("nan"), "b": [float("inf"), 1.5], "c": ("x",)})
    assert json.loads(capsys.readouterr().out) == {"a": None, "b": [None, 1.5], "c": ["x"]}


def test_nothing_that_steers_a_terminal_reaches_it(capsys):
    print_table("\x1b[31mRED\a", ("a\x9b", "b"), [("x\u202ey\tz", "1")])
    shown = capsys.readouterr().out
    assert "?[31mRED?" in shown and "a?" in shown and "x?y z" in shown
    assert not set(shown) & set("\x1b\a\x9b\u202e")


WARM_UP_TWO = LINE + "overrides: {wide: {stations.press.servers: 2}}\nscenarios: {base: [], wider: [wide]}\n"


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("warm")
    opsim("run", line(folder, WARM_UP_TWO), "-o", folder / "out")
    return folder / "out"


def test_each_variant_gets_its_suggestion(results):
    code, shown, _ = opsim("warm-up", results)
    assert code == 0 and "base" in shown and "wider" in shown and "Jobs inside" in shown and "MSER-5" in shown


def test_where_no_warm_up_is_found_none_is_to_be_taken(tmp_path):
    file = line(tmp_path, LINE)
    opsim("run", file, "-o", tmp_path / "out", "--horizon", "2 min")
    _, shown, _ = opsim("warm-up", tmp_path / "out")
    assert "No warm-up is found in any series" in shown and "Take the longest" not in shown


def test_a_folder_that_is_a_file_is_named_with_what_was_expected(tmp_path):
    file = line(tmp_path, LINE)
    assert opsim("run", file, "-o", file)[::2] == (2, f"{file}: found a file, expected a folder to write into\n")


def test_one_variant_as_json(results):
    code, shown, _ = opsim("warm-up", results / "base", "--json")
    (found,) = json.loads(shown)["variants"]
    assert code == 0 and found["replications"] == 2 and found["own_warm_up_s"] == 0
    assert [of["kpi"] for of in found["series"]] == ["work_in_progress", "throughput_per_h"]


def test_a_picture_is_drawn_for_each_variant(results, tmp_path):
    code, shown, _ = opsim("warm-up", results, "--picture", tmp_path / "warm.svg")
    assert code == 0 and "picture:" in shown
    assert {path.name for path in tmp_path.iterdir()} == {"warm_base.svg", "warm_wider.svg"}
    assert "<svg" in (tmp_path / "warm_base.svg").read_text(encoding="utf-8")


def test_wrong_calls_are_mistakes(results, tmp_path):
    assert opsim("warm-up", tmp_path)[0] == 2
    code, _, complaint = opsim("warm-up", results, "--picture", tmp_path / "warm.pdf")
    assert code == 2 and "a .png or a .svg file" in complaint
