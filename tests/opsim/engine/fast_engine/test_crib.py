"""The crib: who calls for a worker with tools that others take meanwhile, and what is put back in one instant."""

from twins import twins

from opsim.log import HELD, NO_TOOL, TOOL

SHARED = """
opsim: 1
name: crib
run: {start: Mon 06:00, horizon: 1200 s, seed: 2}
layout: {places: {a: [0 m, 0 m], b: [0 m, 3 m], c: [0 m, 6 m]}}
tools: {gun: {n: 1}, jig: {n: 2}}
tasks:
  long: {fixed: 8 s, needs: {gun: 1, jig: 1}}
  short: {fixed: 4 s, needs: {jig: 2}}
  held: {fixed: 6 s, needs: {jig: 1}, hold: {tool: gun, from: 0.5, to: 1}}
defaults: {stations: {buffer: 2}}
stations: {s: {at: a, tasks: [long], servers: 2}, t: {at: b, tasks: [short, held]}, u: {at: c, tasks: [held, long]}}
products: {x: {share: 0.4, route: [s, t, u]}, y: {share: 0.6, priority: 1, route: [u, s]}}
release: {kind: renewal, every: {fixed: 10 s}, at_once: 2}
workers:
  k: {walk: 1 m/s, skills: {s: 1.0, t: 1.0, u: 1.0}}
  l: {walk: 1 m/s, skills: {s: 1.0, t: 1.0, u: 1.0}}
"""


def n_waits(log):
    return len(log.where((log["kind"] == HELD) & (log["cause"] == NO_TOOL)))


def test_what_one_takes_others_call_for_no_more():
    log = twins(SHARED)
    assert n_waits(log) > 20 and len(log.of(TOOL)) > 20


def test_a_station_that_closes_or_stops_in_the_midst_changes_nothing_of_that():
    jam = "maintenance: {clean: {every: 50 s, lasts: 20 s, when: at_once}}, "
    log = twins(SHARED, ("u: {at: c,", f"u: {{at: c, {jam}"), ("t: {at: b,", f"t: {{at: b, {jam}"))
    assert n_waits(log) > 10


def test_people_who_go_on_a_break_put_their_tools_back():
    shift = "shifts: {day: {from: 06:00, to: 14:00, breaks: {tea: {at: 06:03, lasts: 2 min}}}}\n"
    log = twins(SHARED + shift, ("k: {", "k: {shift: day, "), ("l: {", "l: {shift: day, "))
    assert n_waits(log) > 10
