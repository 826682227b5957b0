"""Overtime on both engines: who stays, for what, and until when; on floors of more stations than a word has bits."""

import pytest
from twins import twins

from opsim.log import FINISH, OFF

HEAD = """
opsim: 1
name: overtime
run: {start: Mon 06:00, horizon: 60 min, seed: 5}
layout: {places: {bay: [0 m, 0 m], shed: [20 m, 0 m]}}
shifts:
  early: {from: 06:00, to: 06:20, overtime: {most: 16 min}, breaks: {tea: {at: 06:10, lasts: 2 min}}, at_end: resume}
  mid: {from: 06:10, to: 06:30, overtime: {most: 9 min}, at_end: hand_over}
  late: {from: 06:21, to: 07:30}
"""
CELL = (
    HEAD
    + """
tasks:
  load: {fixed: 40 s}
  mill: {dist: lognormal, mean: 3 min, cv: 0.9, automatic: true}
  lift: {fixed: 30 s, team: 2}
stations:
  mill: {at: bay, tasks: [load, mill, load], servers: 2, buffer: 2}
  oven: {at: bay, tasks: [mill], servers: 2, buffer: 1, HOURS}
  bench: {at: shed, tasks: [load, lift], buffer: 1}
products:
  part: {route: [mill, oven, bench]}
  lid: {route: [oven, bench], carried: true}
sources: {s: {kind: saturated, products: [part]}, t: {kind: poisson, every: 200 s, products: [lid]}}
workers:
  ana: {shift: early, walk: 1 m/s, skills: {mill: 1.0, bench: 1.0}}
  ben: {shift: early, walk: 1 m/s, skills: {mill: 0.9}}
  cem: {shift: mid, walk: 1 m/s, skills: {bench: 1.1}}
  dora: {shift: late, absence: 0.5, walk: 1 m/s, skills: {bench: 0.7, mill: 1.0}}
  eva: {walk: 1 m/s, skills: {bench: 1.0}}
"""
)


@pytest.mark.parametrize("hours", ["", ", shift: early", ", shift: late", ", shift: mid, at_close: resume"])
@pytest.mark.parametrize("replication", range(2))
def test_who_stays_stays_as_long_in_both(hours, replication):
    log = twins(CELL, (", HOURS", hours), replication=replication)
    assert len(log.of(OFF)) >= 5 and len(log.of(FINISH)) >= 3


def test_floors_of_more_stations_than_bits_are_seen_whole():
    """75 stations in a row, the last of them the only ones where those are needed whose shift is over."""
    names = [f"s{n:02d}" for n in range(75)]
    made = [f"  {name}: {{at: bay, tasks: [{'pack' if n > 70 else 'run'}], buffer: 2}}" for n, name in enumerate(names)]
    tasks = "tasks: {run: {fixed: 11 s, automatic: true}, pack: {fixed: 95 s}}"
    text = f"{HEAD}{tasks}\nstations:\n" + "\n".join(made) + f"\nproducts: {{p: {{route: [{', '.join(names)}]}}}}\n"
    people = "workers: {ana: {shift: early, skills: {s72: 1, s73: 1}}, ben: {shift: mid, skills: {s71: 1, s74: 1}}}\n"
    log = twins(text + "sources: {s: {kind: poisson, every: 80 s, products: [p]}}\n" + people)
    assert len(log.of(FINISH)) >= 3
    assert sorted(log.of(OFF)["start_s"])[-1] > 1300  # somebody has stayed on
