from opsim.report.sections.summary import sentences
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


def test_where_hours_are_kept_and_stock_lies_the_first_sentence_says_so():
    rows = [*summary()["kpis"], kpi("stock", "shelf", unit="jobs")]
    first = sentences(summary(kpis=rows, scheduled_h=6.5))[0]
    assert first.startswith("60.1 (59.1 to 61.1) jobs per scheduled hour are finished")
    assert first.endswith("are inside on average, stock included.")


def test_one_replication_is_said_to_prove_nothing():
    alone = [kpi("throughput_per_h", unit="1/h", mean=60.0, half_width=None, n=1)]
    first, certainty = sentences(summary(kpis=alone, replications=1))
    assert first == "60.00 jobs an hour are finished."
    assert "there is no interval" in certainty


def test_without_figures_only_the_certainty_is_left():
    assert len(sentences(summary(kpis=[]))) == 1


def test_with_shifts_the_busiest_worker_is_so_of_his_time_on_duty():
    duty = [
        kpi("duty_use", name, unit="share", mean=mean, half_width=0.01) for name, mean in (("ana", 0.5), ("ben", 0.9))
    ]
    all_of_them = kpi("duty_use", unit="share", mean=0.95, half_width=0.01)
    found = sentences(summary(kpis=[*summary()["kpis"], all_of_them, *duty]))
    assert found[1] == (
        "The busiest worker is ben: at work or on the way for 90.0 % (89.0 to 91.0) of the time on duty, breaks aside."
    )


def test_overtime_and_absence_are_said_where_there_were_some():
    def said(over, missed):
        rows = [kpi("overtime_h", unit="h", mean=over, half_width=None), kpi("absent_share", unit="share", mean=missed)]
        return sentences(summary(kpis=rows))[:-1]

    assert said(0.0, 0.0) == []
    assert said(2.5, 0.0) == ["After their shifts people stay for 2.500 h in all."]
    assert said(0.0, 0.05)[0].startswith("5") and said(0.0, 0.05)[0].endswith("of the time of shifts is missed.")
