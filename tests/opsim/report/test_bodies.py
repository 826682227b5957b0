import json
from types import SimpleNamespace

import numpy as np
import pytest
from plans import ran

from opsim.ergonomics.shift.ledger import Regions, timeline
from opsim.ergonomics.shift.worst import worst_frames
from opsim.log import BREAK, NAMED, WAIT, event_log
from opsim.report.sections.exposure import bodies_of, day_of, pauses, regions_said, write_postures
from opsim.report.sections.postures import pair, posture_cards
from opsim.report.sections.worker_timeline import Strip, draw_day, legend
from tests.opsim.ergonomics.shift.test_regions import CELL
from tests.opsim.kpi.made_logs import row


@pytest.fixture(scope="module")
def cell():
    log, plan = ran(CELL)
    return log, plan, worst_frames(log, plan, 2)


def test_a_strip_is_filled_by_the_share_of_each_minute_at_a_high_score(cell):
    log, plan, _ = cell
    day = timeline(log, plan)
    section = day_of(day, plan, "Mon 06:30")
    assert section["minutes"] == 1 and b"ana" in section["picture"] and b"06:40" in section["picture"]
    share = day.from_5_s[0].sum() / (60 * day.from_5_s.shape[1])
    assert f"{100 * share:.2f}"[:4] in section["alt"] and "RULA 5 or more" in section["alt"]
    words = [words for _, words in section["legend"]]
    assert "RULA 5 or more" in words and "at work, posture not known" in words


def test_breaks_that_follow_each_other_are_one_stretch_of_the_strip():
    names = dict.fromkeys(NAMED, ())
    rows = [row(BREAK, 0, 60, worker=0), row(BREAK, 60, 90, worker=0), row(BREAK, 500, 900, worker=0)]
    log = event_log([*rows, row(BREAK, 10, 20, worker=1), row(WAIT, 200, 300, worker=0)], 1000.0, names)
    assert pauses(log, 0, 0.0, 600.0) == [pytest.approx((0.0, 0.15)), pytest.approx((500 / 600, 1.0))]
    assert pauses(log, 2, 0.0, 600.0) == []


def test_breaks_are_hatched_and_in_the_legend():
    paused = [Strip("ana", {"rula_from_5": np.array([0.5, 0.5])}, pauses=((0.2, 0.4),))]
    assert b"url(#pause)" in draw_day(paused, "Mon 06:00", 0.0, 600.0) and "hatched" in legend(paused)[-1][1]
    plain = [Strip("ana", {"rula_from_5": np.array([0.5, 0.5])})]
    assert b"pause" not in draw_day(plain, "Mon 06:00", 0.0, 600.0) and len(legend(plain)) == 1


def test_a_card_says_who_when_and_what_drives_the_score_and_draws_two_views(cell):
    *_, worst = cell
    first, _ = posture_cards(worst)
    assert worst[0].worker in first["title"] and worst[0].task in first["title"] and worst[0].clock in first["when"]
    assert "RULA" in first["scores"] and first["drives"].startswith("Points of the score come from")
    assert len(first["pictures"]) == 2 and all(svg.startswith("<svg") for svg in first["pictures"])
    assert [name for name, *_ in first["parts"]][:2] == ["trunk", "neck"]


def test_the_regions_of_one_replication_are_said_in_shares(cell):
    _, plan, _ = cell
    regions = Regions(plan)
    regions.seconds[0] = [[60.0, 60.0], *[[0.0, 0.0]] * 4, [180.0, 0.0], [0.0, 0.0]]
    assert regions_said(regions) == [
        "What brings people to RULA 5 or more: the load (75 %) and the trunk (25 %).",
        "What brings them to RULA 7: the trunk (100 %).",
    ]


def test_a_score_is_one_number_or_an_interval():
    assert pair((7, 7)) == "7" and pair((5, 7)) == "5 to 7"


def test_the_postures_are_kept_for_whoever_opens_the_folder(cell, tmp_path):
    *_, worst = cell
    write_postures(worst, tmp_path / "postures.json")
    found = json.loads((tmp_path / "postures.json").read_text())["worst"]
    assert [one["worker"] for one in found] == [one.worker for one in worst]
    assert len(found[0]["joints_m"]) == len(found[0]["joints"]) and found[0]["why"]["rula"]["drives"]


def test_where_nobody_asked_for_postures_there_is_nothing():
    assert bodies_of(SimpleNamespace(summary={"kpis": [{"kpi": "throughput_per_h"}]}, log="there")) is None
