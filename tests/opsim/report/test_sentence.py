from opsim.report.sentence import sentences
from tests.made_result import kpi, summary


def test_the_summary_gives_each_figure_with_its_interval():
    first, worker, station, certainty = sentences(summary())
    assert first == (
        "60.1 (59.1 to 61.1) jobs an hour are finished, a job stays 23.1 min (22.1 to 24.1) and 7.10 jobs "
        "(6.90 to 7.30) are inside on average."
    )
    assert worker == "The busiest worker is ana: 82.0 % (81.0 to 83.0) of the time at work."
    assert "most often blocked is weld: 20.0 % (19.0 to 21.0)" in station
    assert certainty.startswith("20 replications, counted from Mon 06:30 to Mon 14:00; in brackets the 95 %")


def test_one_replication_is_said_to_prove_nothing():
    alone = [kpi("throughput_per_h", unit="1/h", mean=60.0, half_width=None, n=1)]
    first, certainty = sentences(summary(kpis=alone, replications=1))
    assert first == "60.00 jobs an hour are finished."
    assert "there is no interval" in certainty


def test_without_figures_only_the_certainty_is_left():
    assert len(sentences(summary(kpis=[]))) == 1
