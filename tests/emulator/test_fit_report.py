import json
from dataclasses import replace

from emulator.fitting.report import FitReport
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
