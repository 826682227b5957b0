import pytest
from plans import line, queue

from opsim.report.sections.summary import keeps_up
from tests.opsim.report.made_floor import floor


@pytest.mark.parametrize("every, up", [("100 s", True), ("30 s", False)])
def test_a_floor_keeps_up_where_as_much_leaves_as_comes_in(every, up):
    assert keeps_up(floor(queue(horizon="100 h", warm_up="1 h", every=every, mean="60 s"))) is up


def test_where_the_floor_decides_what_comes_in_there_is_nothing_to_keep_up_with():
    assert not keeps_up(floor(line(2, 1, horizon="2000 s")))


def test_without_rows_it_is_not_known():
    made = queue(horizon="10 h", warm_up="1 h", every="100 s", mean="60 s")
    assert not keeps_up(floor(made, keeps_rows=False))


def test_jobs_turned_away_are_jobs_not_kept_up_with():
    """As much leaves as is let in, yet of jobs every 100 s that take 60 s many find no room."""
    made = queue(horizon="50 h", warm_up="1 h", every="100 s, when_full: lose", mean="60 s")
    tight = floor(made, ("servers: 1}", "servers: 1, buffer: 1}"))
    assert tight.rows("lost_share")[0]["mean"] > 0.1 and not keeps_up(tight)
