import json
import shutil

import pytest

from opsim.cli.view import Drawn, too_large, window_s
from opsim.scenario import read_scenarios
from opsim.shipped import shipped_folder
from opsim.study import run_scenario
from tests.opsim.cli.calls import line, opsim

CELL = """
opsim: 1
name: A cell
run: {start: Mon 06:00, horizon: 6 min, replications: 2, seed: 3}
libraries: {bench: bench_work.npz}
layout: {places: {here: [0 m, 0 m], there: [3 m, 0 m]}}
tasks: {reach: {emulator: bench/reach}, wait: {fixed: 20 s}}
stations:
  left: {at: here, tasks: [reach], buffer: 3}
  right: {at: there, tasks: [wait], buffer: 3}
products: {part: {route: [left, right]}}
release: {kind: saturated}
workers: {ana: {skills: {left: 1.0, right: 1.0}}}
outputs: [throughput_per_h]
overrides: {two: {workers.ben: {like: ana}}}
scenarios: {alone: [], together: [two]}
"""


def cell(folder, text=CELL):
    """The scenario's file, beside a library of its own."""
    folder.mkdir(exist_ok=True)
    shutil.copy(shipped_folder() / "libraries" / "bench_work.npz", folder / "bench_work.npz")
    (folder / "cell.yaml").write_text(text)
    return folder / "cell.yaml"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Results of both variants, which no test changes."""
    folder = tmp_path_factory.mktemp("view")
    for name, loaded in read_scenarios(cell(folder)).items():
        run_scenario(loaded, folder=folder / "out" / name, processes=1)
    return folder / "out"


@pytest.fixture
def results(run, tmp_path):
    """The same in a folder of one's own."""
    return shutil.copytree(run, tmp_path / "out")


@pytest.fixture
def drawn(monkeypatch):
    """What would be drawn, in place of drawing it."""
    asked = []

    def draw(wanted):
        asked.append(wanted)
        return Drawn(wanted, *(wanted.window_s or (0.0, 360.0)), 1_234_567)

    monkeypatch.setattr("opsim.cli.view.draw_replay", draw)
    return asked


def test_the_page_lies_beside_the_report_and_the_last_line_says_where_and_how_large(results):
    code, said, progress = opsim("view", results / "alone", "--to", "1 min")
    page = results / "alone" / "replay.html"
    assert code == 0 and said.splitlines()[-1] == f"replay: {page} ({page.stat().st_size / 1e6:.1f} MB)"
    assert page.read_text().startswith("<!doctype html>") and "draw alone: " in progress


def test_two_variants_stand_on_one_page_beside_both_folders(results):
    code, said, _ = opsim("view", results, "--scenario", "together", "--scenario", "alone", "--to", "1 min", "--json")
    told = json.loads(said)
    assert code == 0 and told["replay"] == str(results / "replay.html") and told["window_s"] == [0, 60]
    assert [one["variant"] for one in told["variants"]] == ["together", "alone"]
    page = (results / "replay.html").read_text()
    assert 'id="columns-0"' in page and 'id="columns-1"' in page and told["bytes"] == len(page.encode())


def test_a_floor_that_nobody_works_on_is_shown(tmp_path):
    opsim("run", line(tmp_path), "-o", tmp_path / "out", "--processes", 1, "--replications", 1)
    code, said, _ = opsim("view", tmp_path / "out")
    assert code == 0 and (tmp_path / "out" / "base" / "replay.html").is_file() and "replay: " in said


def test_a_stretch_of_the_run_is_named_by_the_clock(results):
    _, said, _ = opsim("view", results / "alone", "--from", "Mon 06:01", "--to", "06:03", "--json")
    assert json.loads(said)["window_s"] == [60, 180]


def test_of_several_variants_the_first_is_shown_and_the_others_are_named(run, drawn):
    _, said, _ = opsim("view", run)
    assert list(drawn[0].runs) == ["alone"] and drawn[0].out == run / "alone" / "replay.html"
    assert "also here: together (--scenario NAME" in said


def test_replication_and_file_are_those_asked_for(run, drawn, tmp_path):
    opsim("view", run, "--replication", 1, "-o", tmp_path / "new" / "x.html")
    assert drawn[0].replication == 1 and drawn[0].out == tmp_path / "new" / "x.html" and drawn[0].window_s is None


def test_every_mistake_is_said_at_once(run, drawn):
    words = ("--scenario", "togethr", "--replication", 2, "--from", "soon", "--to", "Mon 07:00", "-o", "x.txt")
    code, _, complaint = opsim("view", run, *words)
    assert code == 2 and not drawn
    assert complaint.splitlines() == [
        f"{run}: no variant 'togethr'; did you mean 'together'?",
        "x.txt: found the ending '.txt', expected .html",
        f"--replication: found 2, {run / 'alone'} holds 0 to 1",
        "--from: cannot read 'soon' as a time; write '2 h' or a clock, 'Mon 07:30'",
        "--to: found 'Mon 07:00' (Mon 07:00), expected a moment of the run, Mon 06:00 to Mon 06:06 (0.1 h)",
    ]


def test_more_than_two_variants_or_one_twice_are_refused(run):
    names = ("alone", "together", "alone")
    code, _, complaint = opsim("view", run, *(word for name in names for word in ("--scenario", name)))
    assert code == 2 and "found 3, expected one, or two" in complaint and "the same variant twice" in complaint


def test_other_bodies_than_those_that_were_run_are_not_shown(results):
    library = results / "alone" / "bench_work.npz"
    library.write_bytes(library.read_bytes() + b"\0")
    code, _, complaint = opsim("view", results / "alone")
    assert code == 2 and "the library bench has changed since it was run" in complaint
    assert not (results / "alone" / "replay.html").exists()


def test_a_run_without_rows_says_so(results):
    shutil.rmtree(results / "alone" / "events")
    code, _, complaint = opsim("view", results / "alone")
    assert code == 2 and "no rows of events here" in complaint


def test_a_replication_that_is_gone_is_not_another_one(results):
    (results / "alone" / "events" / "replication_00000.parquet").unlink()
    code, _, complaint = opsim("view", results / "alone")
    assert code == 2 and "found no rows of replication 0, expected 0 to 1; run it again" in complaint


def test_rows_that_are_broken_are_no_traceback(results):
    (results / "alone" / "events" / "replication_00000.parquet").write_bytes(b"PAR1")
    code, _, complaint = opsim("view", results / "alone")
    assert code == 2 and "replication_00000.parquet" in complaint


def test_what_is_no_result_is_a_mistake(tmp_path):
    code, _, complaint = opsim("view", tmp_path)
    assert code == 2 and "no results here" in complaint


def test_a_scenario_file_is_run_once_and_shown_and_not_run_again(tmp_path, monkeypatch, drawn):
    monkeypatch.chdir(tmp_path)
    file = cell(tmp_path)
    for _ in range(2):
        code, said, _ = opsim("view", file, "--scenario", "together")
        assert code == 0 and "also here: alone (--scenario NAME" in said
    folder = tmp_path / "results" / "cell_view" / "together"
    assert [path.name for path in (folder / "events").iterdir()] == ["replication_00000.parquet"]
    assert [list(wanted.runs) for wanted in drawn] == [["together"]] * 2
    assert drawn[0].out.resolve() == folder / "replay.html"


def test_a_scenario_that_has_changed_is_run_anew(tmp_path, monkeypatch, drawn):
    monkeypatch.chdir(tmp_path)
    opsim("view", cell(tmp_path))
    code, _, said = opsim("view", cell(tmp_path, CELL.replace("20 s", "30 s")))
    assert code == 0 and "holds the run of a scenario that has changed since" in said
    resolved = (tmp_path / "results/cell_view/alone/scenario.resolved.yaml").read_text()
    assert "30 s" in resolved and len(drawn) == 2


def test_a_file_is_not_run_for_what_it_cannot_show(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("view", cell(tmp_path), "--scenario", "alne", "--from", "9 h")
    assert code == 2 and "did you mean 'alone'?" in complaint and "--from: found '9 h'" in complaint
    assert not (tmp_path / "results").exists()


def test_run_writes_replays_where_they_are_asked_for(run, tmp_path):
    assert not list(run.rglob("replay.html"))
    words = ("-o", tmp_path / "out", "--scenario", "alone", "--replications", 1, "--horizon", "2 min", "--json")
    _, said, _ = opsim("run", cell(tmp_path / "in"), *words, "--replay")
    assert json.loads(said)["results"][0]["replay"] == str(tmp_path / "out" / "alone" / "replay.html")
    assert (tmp_path / "out" / "alone" / "replay.html").is_file()


def test_of_a_large_page_it_is_said_how_many_hours_a_small_one_has_room_for():
    said = too_large(50_000_000, 0.0, 8 * 3600.0, 6 * 3600.0)
    assert said == (
        "50.0 MB are more than the 25 MB that a browser opens quickly, 6.2 MB an hour; "
        "--from 'Mon 06:00' --to 'Mon 10:00' would make 25 MB"
    )


def test_a_page_that_no_browser_opens_is_not_written(results, monkeypatch):
    monkeypatch.setattr("opsim.cli.view.MOST_BYTES", 100_000)
    code, _, complaint = opsim("view", results / "alone", "--to", "1 min")
    assert code == 2 and "replay.html: not written;" in complaint
    assert sorted(path.name for path in (results / "alone").glob("*replay*")) == []


MON_6, H = 6 * 3600.0, 3600.0


def test_times_of_the_run_and_clocks_say_the_same():
    assert window_s("1 h 30 min", "Mon 09:00", MON_6, 8 * H) == (1.5 * H, 3 * H)


def test_one_end_alone_leaves_the_other_where_the_run_has_it():
    assert window_s("2 h", None, MON_6, 8 * H) == (2 * H, 8 * H)
    assert window_s(None, "2 h", MON_6, 8 * H) == (0.0, 2 * H)
    assert window_s(None, None, MON_6, 8 * H) is None


def test_a_clock_without_a_day_is_the_first_such_moment_and_the_second_end_comes_after_the_first():
    assert window_s("Tue 07:30", "08:00", MON_6, 48 * H) == (25.5 * H, 26 * H)
    assert window_s("22:00", "02:00", MON_6, 48 * H) == (16 * H, 20 * H)


@pytest.mark.parametrize(
    ("low", "high", "said"),
    [
        (
            "Mon 15:00",
            None,
            "--from: found 'Mon 15:00' (Mon 15:00), expected a moment of the run, Mon 06:00",
        ),
        ("9 h", None, "--from: found '9 h' (Mon 15:00)"),
        (None, "-1 h", "--to: found '-1 h' (before the start)"),
        ("3 h", "2 h", "expected the later one last"),
        ("2 h", "2 h", "--from and --to: found Mon 08:00 and Mon 08:00"),
        ("90", None, "has no unit"),
        ("soon", None, "--from: cannot read 'soon'"),
        ("25:00", None, "cannot read '25:00' as a clock; write 'Mon 07:30'"),
        ("Mno 07:00", None, "no weekday 'Mno'; did you mean 'Mon'?"),
    ],
)
def test_a_stretch_that_is_none_is_refused_in_words(low, high, said):
    with pytest.raises(ValueError) as refused:
        window_s(low, high, MON_6, 8 * H)
    assert said in str(refused.value)


def test_both_ends_are_judged_at_once():
    with pytest.raises(ValueError) as refused:
        window_s("soon", "Sun 06:00", MON_6, 8 * H)
    assert [line.split(":")[0] for line in str(refused.value).splitlines()] == ["--from", "--to"]
