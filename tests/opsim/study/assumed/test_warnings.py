from plans import line, loaded

from opsim.study.run import run_scenario


def test_a_floor_that_locks_itself_is_said(tmp_path):
    text = line(2, 0, horizon="1000 s", warm_up="0 s").replace("route: [s1, s2]", "route: [s1, s2, s1]")
    result = run_scenario(loaded(text), folder=tmp_path / "r", processes=1, replications=2)
    (warning,) = result.summary["warnings"]
    assert warning.startswith("the floor locked itself in 2 of 2 replications")
    assert "job 1 (part) at s1 waits for a place at s2, job 0 (part) at s2 waits for a place at s1" in warning


def test_a_floor_that_moves_says_nothing(tmp_path):
    result = run_scenario(loaded(line(2, 0, horizon="1500 s")), folder=tmp_path / "r", processes=1, replications=2)
    assert result.summary["warnings"] == []
