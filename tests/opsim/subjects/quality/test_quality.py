"""Defects, inspection, scrap and rework: what chance says of each job, and shares that are known."""

import numpy as np
import pytest
from plans import plan

from opsim.engine.draws import Draws
from opsim.engine.floor.run import run_plan
from opsim.kpi import figures
from opsim.laws.audit import audit
from opsim.log import BAD, COLUMNS, CREATE, FALSE_ALARM, FINISH, REWORK, SCRAP, WORK

LINE = """
opsim: 1
name: quality
run: {horizon: 4 h, seed: 3}
layout: {places: {a: [0 m, 0 m], b: [3 m, 0 m], c: [6 m, 0 m]}}
tasks: {make: {fixed: 30 s}, look: {fixed: 10 s}, mend: {fixed: 20 s}}
stations:
  press: {at: a, tasks: [make], buffer: 2, yield: 0.8}
  check: {at: b, tasks: [look], buffer: 9, inspect: INSPECT}
  solder: {at: c, tasks: [mend], buffer: 9, yield: 0.7}
products: {part: {route: [press, check]}}
release: {kind: poisson, every: 50 s}
workers: {w1: {skills: {press: 1.0}}, w2: {skills: {check: 1.0}}, w3: {skills: {solder: 1.0}}}
"""
REWORKED = "{finds: 0.9, false_alarms: 0.05, then: {rework: solder}, most: 2}"


def line(inspect, *changes, horizon="4 h"):
    text = LINE.replace("INSPECT", inspect).replace("4 h", horizon)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return plan(text)


def logged(p):
    log = run_plan(p)
    audit(log, p)
    return log


def jobs(log, kind, cause=None):
    rows = log.of(kind)
    return set(rows["job"][(rows["cause"] == cause) if cause is not None else slice(None)].tolist())


def test_a_perfect_inspection_scraps_just_the_jobs_that_chance_left_a_defect_in():
    p = line("{then: scrap}")
    log, draws = logged(p), Draws(p, 0)
    spoiled = {n for n in range(len(log.of(CREATE))) if draws.chance(("yield", "press", "release", 0), n) >= 0.8}
    gone = jobs(log, SCRAP) | jobs(log, FINISH)
    assert len(gone) > 250
    assert jobs(log, SCRAP) == spoiled & gone
    assert set(log.of(SCRAP)["station"]) == {p.stations.index(next(s for s in p.stations if s.name == "check"))}


def test_scrap_at_a_station_is_yield_and_a_perfect_inspection_there():
    said, meant = (
        line("{finds: 0}", ("yield: 0.8", quality)) for quality in ("scrap: 0.2", "yield: 0.8, inspect: {then: scrap}")
    )
    assert len(jobs(run_plan(said), SCRAP)) > 40
    assert rows(run_plan(said)) == rows(run_plan(meant))


def rows(log):
    return list(zip(*(np.nan_to_num(log[column], nan=-1).tolist() for column in COLUMNS)))


def test_an_inspection_that_finds_nothing_and_a_yield_of_one_change_no_row():
    plain = line("{finds: 0}", (", yield: 0.8", ""), (", yield: 0.7", ""))
    nothing = line("{finds: 0}", (", inspect: {finds: 0}", ""), ("yield: 0.8", "yield: 1"), (", yield: 0.7", ""))
    assert nothing.quality == ()
    assert rows(run_plan(plain)) == rows(run_plan(nothing))


def test_a_faster_station_spoils_the_same_jobs():
    slow, fast = line("{then: scrap}"), line("{then: scrap}", ("make: {fixed: 30 s}", "make: {fixed: 20 s}"))
    both = jobs(run_plan(slow), FINISH) | jobs(run_plan(slow), SCRAP)
    assert jobs(run_plan(slow), SCRAP) == jobs(run_plan(fast), SCRAP) & both


def test_rework_elsewhere_comes_back_to_be_inspected_again():
    log = logged(line(REWORKED))
    stations = np.array(log.names["station"], dtype=object)
    seen = dict.fromkeys(jobs(log, REWORK), ())
    work = log.of(WORK)
    for job, station in zip(work["job"].tolist(), stations[work["station"]]):
        if job in seen:
            seen[job] += (station,)
    ways = {"-".join(way) for job, way in seen.items() if job in jobs(log, FINISH) | jobs(log, SCRAP)}
    assert ways == {"press-check-solder-check", "press-check-solder-check-solder-check"}


def test_rework_on_the_way_goes_on_from_there():
    log = logged(line(REWORKED, ("[press, check]", "[press, solder, check]")))
    stations = np.array(log.names["station"], dtype=object)
    work = log.of(WORK)
    first = next(job for job in sorted(jobs(log, REWORK)) if job in jobs(log, FINISH))
    way = "-".join(stations[work["station"][work["job"] == first]])
    assert way.startswith("press-solder-check-solder-check")


@pytest.mark.parametrize("rework", ["solder", "check", "press"])
def test_no_job_is_reworked_more_often_than_it_may_and_every_turned_down_one_has_a_cause(rework):
    log = logged(line(REWORKED.replace("solder", rework)))
    times = np.bincount(log.of(REWORK)["job"])
    assert times.max() == 2
    scrapped = jobs(log, SCRAP)
    assert scrapped or rework == "check"  # where rework leaves no defect, two false alarms in a row are rare
    assert scrapped <= set(np.flatnonzero(times == 2).tolist())
    assert set(log.of(SCRAP, REWORK)["cause"]) == {BAD, FALSE_ALARM}


def test_good_and_bad_come_out_in_the_shares_that_the_chances_make():
    """q = 0.8 leaves the press good; what is turned down is soldered at 0.7, up to twice; finds 0.9, false alarms 0.05.

    Turned down: good 0.05, bad 0.9. Shares of jobs by hand, after each look: bound 4 standard errors.
    """
    log = run_plan(line(REWORKED, horizon="150 h"))
    good, bad, passed_good, passed_bad = 0.8, 0.2, 0.0, 0.0
    for _ in range(3):
        passed_good, passed_bad = passed_good + 0.95 * good, passed_bad + 0.1 * bad
        turned_down = 0.05 * good + 0.9 * bad
        good, bad = 0.7 * turned_down, 0.3 * turned_down
    n = len(log.of(FINISH)) + len(log.of(SCRAP))
    assert n > 10_000
    expected = {"good": passed_good, "bad": passed_bad, "scrap": turned_down}
    bad_out = len(jobs(log, FINISH, BAD))
    found = {"good": len(log.of(FINISH)) - bad_out, "bad": bad_out, "scrap": len(log.of(SCRAP))}
    for what, share in expected.items():
        assert abs(found[what] / n - share) < 4 * np.sqrt(share * (1 - share) / n), what


def test_a_scrapped_job_gives_back_the_place_that_was_kept_for_it():
    p = line(
        "{finds: 0.9}",
        ("yield: 0.8", "yield: 0.5, inspect: {}, blocking: before"),
        ("buffer: 9, insp", "buffer: 0, insp"),
    )
    log = logged(p)
    assert len(jobs(log, SCRAP)) > 100
    assert len(jobs(log, FINISH)) > 100


def test_figures_of_quality_are_what_the_rows_say():
    p = line(REWORKED)
    log = run_plan(p)
    found = {(f.kpi, f.subject): f.value for f in figures(log, p)}
    finished, scrapped, bad = len(log.of(FINISH)), len(log.of(SCRAP)), len(jobs(log, FINISH, BAD))
    at_once = jobs(log, FINISH) - jobs(log, FINISH, BAD) - jobs(log, REWORK)
    assert found["scrap_per_h", ""] == found["scrap_per_h", "check"] == scrapped / 4
    assert found["rework_per_h", "check"] == len(log.of(REWORK)) / 4
    assert found["scrap_share", ""] == scrapped / (scrapped + finished)
    assert found["first_pass_yield", ""] == len(at_once) / (scrapped + finished)
    assert found["defects_out_share", ""] == bad / finished
    assert found["throughput_per_h", ""] == (finished - bad) / 4
    assert 0 < found["false_alarm_share", ""] < 0.5
