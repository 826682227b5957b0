"""What a notebook shows: small, well-formed, and harmless whatever things are called."""

from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import simpy

from opsim import Worker
from opsim.ergonomics.redraw import performance_again
from opsim.log import WORK
from opsim.results import Result
from opsim.study.compare import compare
from opsim.study.run import reopened
from tests.made.result import NAMES, hostile
from tests.opsim.export import hostile as harmful
from tests.opsim.export.made_export import ran
from tests.opsim.export.made_results import results, variants

MOST_BYTES = 20_000


def looked_at(thing):
    """The elements that a notebook would make of it, checked."""
    html = thing._repr_html_()
    assert len(html.encode()) < MOST_BYTES
    tree = ElementTree.fromstring(f"<div>{html}</div>")
    for one in tree.iter():
        tag = one.tag.partition("}")[2] or one.tag
        assert tag not in ("script", "img", "iframe", "style", "link", "b")
        assert not [name for name in one.attrib if name.startswith("on") or name in ("src", "href")]
    return tree


def text_of(tree):
    return " ".join(" ".join(tree.itertext()).split())


@pytest.fixture(scope="module")
def run():
    return reopened(results() / "base")


def test_results_show_what_was_run_and_their_figures():
    words = text_of(looked_at(variants()["base"]))
    assert "Little cell, variant base: 2 replications, seed 7." in words and "throughput_per_h" in words


def test_a_log_shows_its_kinds_and_what_workers_did(run):
    tree = looked_at(run.log())
    words = text_of(tree)
    assert f"{len(run.log()):,} rows of replication 0, 10 min." in words and "create" in words and "ana" in words
    wide = [float(one.attrib["width"]) for one in tree.iter("{http://www.w3.org/2000/svg}rect") if len(one)]
    assert sum(wide) == pytest.approx(480 - 110, abs=1)  # all of the worker's time


def test_a_scenario_and_its_plan_show_who_works_where(run):
    for thing in (run.loaded, run.plan):
        words = text_of(looked_at(thing))
        assert "2 stations, 1 worker, 1 product" in words and "unload" in words and "lift" in words
    assert "from Tue 06:00 on" in text_of(looked_at(run.loaded))


def test_a_performance_shows_whose_it_is_and_its_body(run):
    log, plan = run.log(), run.plan
    tasks = [task.name for task in plan.tasks]
    for task, paths in (("lift", 7), ("label", 0)):
        row = int(np.flatnonzero((log["kind"] == WORK) & (log["task"] == tasks.index(task)))[0])
        tree = looked_at(performance_again(log, plan, row))
        assert f"ana, {task}, performance 0" in text_of(tree)
        assert len(list(tree.iter("{http://www.w3.org/2000/svg}path"))) == paths


def test_a_comparison_shows_what_is_clear_first():
    words = text_of(looked_at(compare(variants(), "base", ())))
    assert "differences from base, 2 pairs" in words and "near" in words


def test_harmful_names_do_no_harm(run):
    log, plan = harmful.hostile(*ran("pump_plant"))
    for thing in (log, plan):
        words = text_of(looked_at(thing))
        assert "<script>" in words or harmful.UP in words
    looked_at(Result(results(), hostile()))
    looked_at(replace(run.loaded, variant=NAMES[0]))


def test_somebodys_own_worker_with_a_harmful_name_does_no_harm():
    env = simpy.Environment()
    worker = Worker(env, NAMES[0], {"lift": "public_movements/deep_squat"}, seed=7)
    done = env.run(worker.perform("lift"))
    assert NAMES[0] in text_of(looked_at(done))
    looked_at(worker.log)
