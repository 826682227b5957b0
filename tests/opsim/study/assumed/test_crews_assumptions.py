"""What the assumption sheet says of crews."""

from plans import loaded

from opsim.plan import compile_plan
from opsim.study.assumptions.assignment import crews

TEXT = """
opsim: 1
name: crews
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: hall, tasks: [t], servers: 2}, b: {at: hall, tasks: [t]}, c: {at: hall, tasks: [t]}}
products: {bag: {route: [a, b, c]}}
release: {kind: poisson, every: 60 s}
workers: {ana: {skills: {a: 1, b: 1}}, ben: {skills: {a: 1, b: 1, c: 1}}, cem: {skills: {b: 1, c: 1}}}
crews: {row: {kind: bucket_brigade, stations: [a, b], workers: [ben, ana]}}
"""


def said(text=TEXT):
    read = loaded(text)
    return [line for _, line in crews(read, compile_plan(read))]


def test_the_order_the_way_and_skills_that_count_for_nothing_are_said():
    first, *others = said()
    assert first.startswith("row: ben, ana, in this order; who comes back takes over the job of the one before him")
    assert others == [
        "a: side by side somebody may be further in a task, nobody leaves out of turn",
        "cem: could work at stations of row as well, and never do: no members",
        "ben: could work elsewhere as well, and never do: members of row",
    ]


def test_a_rabbit_chase_goes_by_itself():
    assert (
        "everybody goes with his job to the end of the line" in said(TEXT.replace("bucket_brigade", "rabbit_chase"))[0]
    )
