"""The shipped ``skill_chain.yaml`` and ``cherry_picking.yaml``: what skills are worth where, in paired intervals.

Directions as in Hopp, Tekin & Van Oyen (2004), Benefits of skill chaining in serial production lines with cross-trained
workers, Management Science 50(1):83-98.
"""

import numpy as np
import pytest

from opsim.scenario import read_scenarios
from opsim.study import run_scenario
from opsim.study.compare import compare
from opsim.study.intervals import t_interval


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Results of all variants of both files."""
    folder = tmp_path_factory.mktemp("skills")
    return {
        file: {name: run_scenario(one, folder=folder / file / name) for name, one in read_scenarios(file).items()}
        for file in ("skill_chain", "cherry_picking")
    }


def verdicts(results, base):
    """By variant: what is said of its rate against that of a base."""
    found = compare(results, base, ["throughput_per_h"]).differences
    return {one.variant: one.verdict for one in found if not one.key[1]}


def beyond_half(results, variant):
    """Interval of what a variant gains beyond half of what training everybody for everything gains."""
    rates = {name: _rates(result) for name, result in results.items()}
    return t_interval(rates[variant] - rates["base"] - 0.5 * (rates["full"] - rates["base"]))


def _rates(result):
    of = next(row for key, row in result.kpis().items() if key[0] == "throughput_per_h" and not key[1] and not key[2])
    return np.array([of[replication] for replication in sorted(of)])


@pytest.mark.slow
def test_a_chain_gains_most_of_full_flexibility_in_a_balanced_line_and_cherry_picking_does_not(made):
    results = made["skill_chain"]
    assert verdicts(results, "base") == {"cherry": "no clear difference", "chain": "higher", "full": "higher"}
    assert verdicts(results, "cherry")["chain"] == "higher"
    assert beyond_half(results, "chain").low > 0
    assert beyond_half(results, "cherry").high < 0


@pytest.mark.slow
def test_cherry_picking_gains_most_of_it_where_one_station_is_the_bottleneck_and_more_than_a_chain(made):
    results = made["cherry_picking"]
    assert set(verdicts(results, "base").values()) == {"higher"}
    assert verdicts(results, "chain")["cherry"] == "higher"
    assert beyond_half(results, "cherry").low > 0


def test_cherry_picking_takes_fewer_skills_than_a_chain():
    for file in ("skill_chain", "cherry_picking"):
        n = {
            name: sum(len(worker.skills) for worker in one.scenario.workers.values())
            for name, one in read_scenarios(file).items()
        }
        assert n == {"base": 5, "cherry": 9, "chain": 10, "full": 25}
