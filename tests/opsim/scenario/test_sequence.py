"""What is wrong with the sequence of work is told at its place, with the way out; all at once."""

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: shop
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {cut: {fixed: 10 s, automatic: true}, change: {fixed: 60 s}, crew: {fixed: 60 s, team: 2}}
stations: {saw: {at: hall, tasks: [cut]STATION}}
products:
  a: {share: 0.5, route: [saw], family: big}
  b: {share: 0.5, route: [saw]}
release: {kind: poisson, every: 60 s}
workers: {eve: {skills: {saw: 1}}}
"""


def read(station, more, folder):
    text = TEXT.replace("STATION", station and f", {station}") + more
    return scenarios_in(text.encode(), folder / "shop.yaml")["base"].scenario


@pytest.mark.parametrize("station", [
    "dispatch: downstream_first, preempt: resume, buffer_after: 3, blocking: before",
    "setup: {otherwise: 10 min}",
    "setup: {times: {a: {b: change}, b: {a: 1 min 30 s}}, first: b, attended: false}",
    "setup: {times: {big: {b: 5 min}, b: {big: 0 s}}, by: family}",
])  # fmt: skip
def test_what_is_right_is_read(station, tmp_path):
    read(station, "flow: {dispatch: spt, routing: in_order, blocking: after}\n", tmp_path)


WRONG = {
    ("dispatch: spd", ""): ("stations.saw.dispatch: no rule 'spd'", "did you mean 'spt'?"),
    ("", "flow: {dispatch: fastest}"): ("flow.dispatch: no rule 'fastest'", "known rules: critical_ratio"),
    ("", "flow: {routing: in_oder}"): ("flow.routing: no rule 'in_oder'", "did you mean 'in_order'?"),
    ("", "flow: {blocking: both}"): ("flow.blocking", "after"),
    ("", "flow: {dispatc: spt}"): ("flow.dispatc", "did you mean 'dispatch'?"),
    ("dispatch: edd", ""): ("stations.saw.dispatch: edd goes by due dates, and no job has one", "such as 'due: 4 h'"),
    ("preempt: resume, buffer: 0", ""): (
        "stations.saw.preempt: nothing is ever pre-empted",
        "give the station a buffer",
    ),
    ("preempt: abort", ""): ("stations.saw.preempt", "resume"),
    ("preempt: resume, batch: {size: 4}", ""): ("stations.saw.preempt: the jobs of a batch", "remove 'preempt'"),
    ("blocking: before, batch: {size: 4}", ""): ("stations.saw.batch: the jobs of a batch go on", "'blocking: after'"),
    ("batch: {size: 4}", "flow: {blocking: before}"): ("stations.saw.batch: the jobs of a batch go on", ""),
    ("buffer_after: -1", ""): ("stations.saw.buffer_after", "-1"),
    ("setup: {}", ""): ("stations.saw.setup: nothing says how long a set-up takes", "add e.g. 'otherwise: 10 min'"),
    ("setup: {otherwise: 5}", ""): ("stations.saw.setup.otherwise", "5 s"),
    ("setup: {otherwise: -5 s}", ""): ("stations.saw.setup.otherwise: must be from 0 s", ""),
    ("setup: {otherwise: 5 mins}", ""): ("stations.saw.setup.otherwise", "min"),
    ("setup: {otherwise: chnge}", ""): ("stations.saw.setup.otherwise: no task 'chnge'", "did you mean 'change'?"),
    ("setup: {otherwise: crew}", ""): ("stations.saw.setup.otherwise: 'crew' has 'team'", ""),
    ("setup: {times: {a: {c: 5 s}}, otherwise: 5 s}", ""): ("stations.saw.setup.times.a.c: no product 'c'", "known"),
    ("setup: {times: {a: {b: 5 s}}, by: family, otherwise: 5 s}", ""): (
        "stations.saw.setup.times.a: no family 'a'",
        "",
    ),
    ("setup: {first: x, otherwise: 5 s}", ""): ("stations.saw.setup.first: no product 'x'", ""),
    ("setup: {times: {a: {b: 5 s}}}", ""): (
        "stations.saw.setup: nothing says how long the set-up from 'b' to 'a'",
        "add it",
    ),
}


@pytest.mark.parametrize("wrong", WRONG, ids=" ".join)
def test_what_is_wrong_is_told_with_the_way_out(wrong, tmp_path):
    station, more = wrong
    with pytest.raises(ScenarioError) as caught:
        read(station, more + "\n", tmp_path)
    said = "\n".join(f"{one.path}: {one.message} | {one.hint}" for one in caught.value.problems)
    message, hint = WRONG[wrong]
    assert message in said and hint in said
    assert len(caught.value.problems) == 1


def test_a_setup_that_nobody_can_do_is_told(tmp_path):
    with pytest.raises(ScenarioError, match="the set-up needs a worker, and no worker has the skill 'saw'"):
        scenarios_in(
            TEXT.replace("STATION", ", setup: {otherwise: 5 s}").replace("workers:", "#").encode(),
            tmp_path / "shop.yaml",
        )


def test_all_mistakes_are_told_at_once(tmp_path):
    with pytest.raises(ScenarioError) as caught:
        read(
            "dispatch: spd, preempt: resume, buffer: 0, setup: {first: x, otherwise: y}",
            "flow: {routing: z}\n",
            tmp_path,
        )
    assert len(caught.value.problems) == 5
