from plans import plan

from opsim.log import WALK
from opsim.report.sections.common import walked_ways
from opsim.report.sections.walking import walk_sentences
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.study.layout.made_floor import FLOOR


def said(rows, walks=((0, "p1", "p5"),)):
    p = plan(FLOOR)
    at = p.places.index
    log = made(
        [row(WALK, 100 * n, 100 * n + 20, worker=w, places=(at(a), at(b))) for n, (w, a, b) in enumerate(walks)], p
    )
    return list(walk_sentences(walked_ways(log, p), p, p.places, rows))


def of(name, mean, half=None):
    ends = {"low": None, "high": None} if half is None else {"low": mean - half, "high": mean + half}
    return {"subject": name, "mean": mean} | ends


def test_who_walks_most_is_said_with_its_interval():
    assert said([of("ana", 1000.0, 50.0), of("ben", 400.0, 20.0)])[0] == (
        "ana walks most: 1,000 (950 to 1,050) m an hour; ben least, 400 (380 to 420)."
    )


def test_where_closed_hours_are_counted_that_is_said():
    shift = "shifts: {s: {from: '00:10', to: '00:50'}}\nworkers: {ana: {shift: s, "
    p = plan(FLOOR.replace("workers: {ana: {", shift).replace("{horizon: 1 h", "{start: Mon 00:00, horizon: 2 h"))
    log = made([row(WALK, 700, 720, worker=0, places=(p.places.index("p1"), p.places.index("p5")))], p)
    (said,) = walk_sentences(walked_ways(log, p), p, p.places, [])
    assert "m an hour of the 2 h counted, closed ones too, 100 %" in said


def test_who_does_not_walk_and_who_walks_alike_is_said():
    assert said([of("ana", 10.0), of("ben", 0.0)])[0].endswith("ben not at all.")
    assert said([of("ana", 10.0), of("ben", 10.0)])[0].endswith("all walk as far.")
    assert len(said([of("ana", 10.0)])) == 1


def test_the_way_walked_most_is_that_of_most_metres():
    walks = [(0, "p1", "p5"), (0, "p1", "p2"), (1, "p2", "p1"), (1, "p2", "p1")]
    assert said([], walks) == [
        "In the first replication most is walked between p1 and p5: 1 trip and 20 m an hour, 57 % of all that people "
        "walk between places."
    ]
