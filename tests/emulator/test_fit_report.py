import json
from dataclasses import replace

from emulator.fitting.noise import NOISES
from emulator.fitting.report import FitReport
from emulator.fitting.summary import stiffness_said
from tests.emulator.fitted import made


def test_a_report_survives_json():
    report = made("lift")[1].report
    assert FitReport.of_dict(json.loads(json.dumps(report.as_dict()))) == report


def test_what_could_not_be_estimated_is_null_in_json():
    plain = replace(made("lift")[1].report, icc=float("nan")).as_dict()
    assert json.loads(json.dumps(plain, allow_nan=False))["icc"] is None
    assert FitReport.of_dict(plain).icc != FitReport.of_dict(plain).icc


def test_the_rows_say_what_a_user_must_know():
    labels = [label for label, _ in made("lift")[1].report.rows()]
    assert labels[:5] == ["sequences", "components", "explained variance", "reconstruction, held out", "duration"]


def test_the_methods_say_which_noise_was_chosen_and_how_much_a_known_worker_takes_from_others():
    methods = made("lift")[1].report.methods
    for stiffness, most in NOISES:
        words = stiffness_said((stiffness, most), 0.0)
        assert (
            f"noise {stiffness:g} times as smooth" in words and f"at most {100 * most:.0f} % of the variance" in words
        )
    assert any(methods["stiffness"].startswith(stiffness_said(noise, 0.0).split(":")[0]) for noise in NOISES)
    assert any("with the weight of 0.5 repetitions from everybody's" in words for words in methods.values())
