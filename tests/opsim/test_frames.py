import sys

import numpy as np
import pytest

from opsim.log import COLUMNS, NAMED
from opsim.study.compare import compare
from tests.opsim.export.made_export import ran
from tests.opsim.export.made_results import variants


def test_a_log_as_a_frame_has_its_rows_with_names_as_text():
    pytest.importorskip("pandas")
    log, _ = ran("pump_plant")
    frame = log.to_frame()
    assert list(frame.columns) == ["replication", *COLUMNS] and len(frame) == len(log)
    for name in COLUMNS:
        if name not in NAMED:
            continue
        none = (log[name] < 0) | ((name == "cause") & (log[name] == 0))
        expected = [None if empty else log.names[name][rank] for empty, rank in zip(none, log[name])]
        assert frame[name].astype(object).where(frame[name].notna(), None).tolist() == expected
    assert frame["start_s"].tolist() == log["start_s"].tolist()
    assert frame["job"].isna().tolist() == (log["job"] < 0).tolist()
    assert frame["job"].dropna().tolist() == log["job"][log["job"] >= 0].tolist()


def test_results_as_a_frame_have_every_figure_of_every_replication():
    pytest.importorskip("pandas")
    result = variants()["base"]
    frame, table = result.to_frame(), result.kpis()
    assert len(frame) == sum(map(len, table.values()))
    own = frame[(frame.kpi == "throughput_per_h") & (frame.subject == "")]
    assert dict(zip(own.replication, own.value)) == table["throughput_per_h", "", "", "1/h"]


def test_a_comparison_as_a_frame_has_every_difference_with_its_verdict():
    pytest.importorskip("pandas")
    found = compare(variants(), "base", ())
    frame = found.to_frame()
    assert list(frame.verdict) == [one.verdict for one in found.differences]
    assert np.array_equal(frame.difference, [one.interval.mean for one in found.differences], equal_nan=True)


def test_without_pandas_it_is_said_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    for thing in (ran("pump_plant")[0], variants()["base"], compare(variants(), "base", ())):
        with pytest.raises(ImportError, match=r"pip install opsim\[frames\]"):
            thing.to_frame()
