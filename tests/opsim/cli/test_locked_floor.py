"""A floor that locks itself: ``check`` flags it before the run, and the run names the circle."""

from tests.opsim.cli.calls import line, opsim

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
