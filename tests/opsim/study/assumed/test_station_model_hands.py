"""What the sheet says of quality, tools, teams and attended runs."""

import pytest
from plans import plan

from opsim.study.assumptions.flow import station_model

LINE = """
opsim: 1
name: line
run: {horizon: 100 s}
layout: {places: {a: [0 m, 0 m]}}
tools: {gun: {}}
tasks: {t: {fixed: 1 s, needs: {gun: 1}}, run: {fixed: 3 s, automatic: attended}, lift: {fixed: 2 s, team: 2}}
stations:
  cut:  {at: a, tasks: [t, lift], yield: 0.9}
  look: {at: a, tasks: [run], inspect: {finds: 0.8, false_alarms: 0.02, then: {rework: cut}, most: 3}}
products: {part: {route: [cut, look]}}
release: {kind: poisson, every: 9 s}
workers: {v: {skills: {cut: 1.0}}, w: {skills: {cut: 1.0, look: 1.0}}}
"""


@pytest.mark.parametrize(
    "said",
    [
        "cut: 0.9 of its operations leave no defect, each by chance alone",
        "look: 0.8 of bad jobs is found to be bad, and 0.02 of good ones is held to be bad",
        "look: a job is reworked at most 3 times, then it is scrap; it is good then until an operation leaves a defect "
        "anew",
        "throughput counts good jobs only: one that leaves with a defect nobody found is not in it",
        "tools of a task are taken as its worker sets out, and put back when the work is broken off",
        "run: takes the station's time, whoever attends it and whatever his skill",
        "lift: nobody comes before all can, and the slowest ends it; each has his own time",
    ],
)
def test_the_sheet_says_what_is_assumed_of(said):
    assert said in [words for _, words in station_model(plan(LINE))]
