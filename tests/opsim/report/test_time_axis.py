from datetime import UTC, datetime

from opsim.report.plot.plotly import at_ms, clock_axis


def test_the_clock_of_a_run_reads_as_that_of_its_weekday():
    seen = datetime.fromtimestamp(at_ms(86_400 + 6 * 3600, 90.5).item() / 1000, tz=UTC)
    assert seen.strftime("%a %H:%M:%S") == "Tue 06:01:30"


def test_an_axis_that_may_move_stays_within_its_time():
    still, moves = clock_axis(0, 0, 3600), clock_axis(0, 0, 3600, zoomed=True)
    assert still["fixedrange"] and not moves["fixedrange"]
    assert [moves["minallowed"], moves["maxallowed"]] == moves["range"] and "minallowed" not in still
