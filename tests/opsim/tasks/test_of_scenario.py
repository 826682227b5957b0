"""From the words of the language to the model: every kind, with the mean it says itself."""

from pathlib import Path

import pytest

from opsim.scenario.read import scenarios_in
from opsim.tasks import (
    Beta,
    Empirical,
    Erlang,
    Exponential,
    Fixed,
    Gamma,
    Geometric,
    Hyperexponential,
    Lognormal,
    Normal,
    Recorded,
    Triangular,
    Uniform,
    Weibull,
    task_model,
)

GOOD = (Path(__file__).parents[1] / "scenario/good.yaml").read_text(encoding="utf-8")
KINDS = [
    ("fixed: 3 s", Fixed(3.0), "fixed, 3 s"),
    ("dist: exponential, mean: 3 s", Exponential(3.0), "exponential, mean 3 s"),
    ("dist: erlang, mean: 3 s, k: 2", Erlang(3.0, 2), "erlang of 2, mean 3 s"),
    ("dist: geometric, mean: 3 s, step: 1 s", Geometric(3.0, 1.0), "geometric, mean 3 s in steps of 1 s"),
    ("dist: lognormal, mean: 3 s, cv: 0.2", Lognormal(3.0, 0.2), "lognormal, mean 3 s, cv 0.2"),
    ("dist: gamma, mean: 3 s, cv: 0", Fixed(3.0), "gamma, mean 3 s, cv 0"),
    (
        "dist: gamma, mean: 3 s, cv: 0.2, between_share: 0.4",
        Gamma(3.0, 0.2, 0.4),
        "gamma, mean 3 s, cv 0.2, 40% of it between workers",
    ),
    ("dist: weibull, mean: 3 s, cv: 0.2", Weibull(3.0, 0.2), "weibull, mean 3 s, cv 0.2"),
    ("dist: hyperexponential, mean: 3 s, cv: 2", Hyperexponential(3.0, 2.0), "hyperexponential, mean 3 s, cv 2"),
    ("dist: normal, mean: 3 s, sd: 0.6 s", Normal(3.0, 0.6 / 3), "normal, mean 3 s, cv 0.2, none below 0 s"),
    (
        "dist: normal, mean: 3 s, cv: 0.2, low: 1 s",
        Normal(3.0, 0.2, 0.0, 1.0),
        "normal, mean 3 s, cv 0.2, none below 1 s",
    ),
    ("dist: normal, mean: 3 s, sd: 0 s", Fixed(3.0), "normal, mean 3 s, cv 0, none below 0 s"),
    (
        "dist: beta, low: 1 s, high: 5 s, mean: 3 s, cv: 0.2",
        Beta(3.0, 0.2, 0.0, 1.0, 5.0),
        "beta, 1 to 5 s, mean 3 s, cv 0.2",
    ),
    ("dist: uniform, low: 1 s, high: 5 s", Uniform(1.0, 5.0), "uniform, 1 to 5 s"),
    (
        "dist: triangular, low: 1 s, mode: 2 s, high: 5 s",
        Triangular(1.0, 2.0, 5.0),
        "triangular, 1 to 5 s, most likely 2 s",
    ),
    ("dist: empirical, values: [2 s, 4 s]", Empirical((2.0, 4.0)), "empirical, 2 values, mean 3 s"),
    ("recorded: times.csv", Recorded((2.0, 4.0)), "recorded, times.csv (resample)"),
    ("recorded: times.csv, by: trace", Recorded((2.0, 4.0), by_index=True), "recorded, times.csv (trace)"),
    ("recorded: times.csv, by: smooth", Empirical((2.0, 4.0)), "recorded, times.csv (smooth)"),
]


@pytest.mark.parametrize(("said", "model", "words"), KINDS, ids=[kind[0] for kind in KINDS])
def test_a_task_gets_the_model_it_says(tmp_path, said, model, words):
    (tmp_path / "times.csv").write_text("2\n4\n")
    text = GOOD.replace("fixed: 3 s", said)
    loaded = scenarios_in(text.encode(), tmp_path / "line.yaml")["base"]
    task = loaded.scenario.tasks["lift"]
    assert task_model(task, loaded) == model
    assert task.words == words
    assert getattr(task, "mean_s", model.mean_duration_s()) == model.mean_duration_s()
