import csv
import math

from opsim.report.motion.people import FILES, as_plain, write_tables
from tests.made.people import found


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_each_file_has_the_rows_of_all_tasks(tmp_path):
    write_tables(tmp_path, [found(), found("lift")])
    assert {path.name for path in tmp_path.iterdir()} == set(FILES)
    sizes = {"people.csv": 6, "left_out.csv": 8, "icc.csv": 4, "covariates.csv": 4}
    for name, size in sizes.items():
        rows = rows_of(tmp_path / name)
        assert len(rows) == size and [row["task"] for row in rows] == ["reach"] * (size // 2) + ["lift"] * (size // 2)


def test_a_worker_has_counts_mean_scores_and_a_verdict(tmp_path):
    write_tables(tmp_path, [found()])
    ana, ben, cid = rows_of(tmp_path / "people.csv")
    assert (ana["worker"], ana["repetitions"], ana["judged"], ana["own_closer"]) == ("ana", "2", "2", "yes")
    assert [float(ana[f"known_{part}"]) for part in ("posture", "duration", "sum")] == [0.2, 0.2, 0.4]
    assert ben["own_closer"] == "no" and float(ben["new_sum"]) == 1.5
    assert cid["known_sum"] == cid["new_sum"] == cid["own_closer"] == "" and cid["judged"] == "0"


def test_a_repetition_has_its_own_scores_and_nothing_where_it_was_not_judged(tmp_path):
    write_tables(tmp_path, [found()])
    rows = rows_of(tmp_path / "left_out.csv")
    assert [(row["worker"], row["trial"]) for row in rows] == [
        ("ana", "r1"),
        ("ana", "r2"),
        ("ben", "r1"),
        ("cid", "r1"),
    ]
    assert float(rows[1]["known_posture"]) == 0.3 and float(rows[1]["known_sum"]) == 0.5
    assert rows[3]["known_posture"] == "" and float(rows[3]["pooled_sum"]) == 1.0


def test_a_covariate_has_its_figures_and_one_that_tells_nothing_its_note(tmp_path):
    write_tables(tmp_path, [found()])
    told, other = rows_of(tmp_path / "covariates.csv")
    assert (told["covariate"], told["r2"], told["kept"], told["note"]) == ("height", "0.5", "yes", "")
    assert (other["covariate"], other["r2"], other["note"]) == ("vmax", "", "changes")


def test_json_has_the_same_rows_by_column():
    plain = as_plain(found())
    assert set(plain) == {"people", "left_out", "icc", "covariates"}
    assert plain["icc"][0] == {"task": "reach", "quantity": "log duration", "icc": 0.5, "low_95": -0.1, "high_95": 0.9}
    assert math.isnan(plain["left_out"][3]["known_sum"])
