"""Who is sent where, as SimPy's engine sends them: more stations than fit into one word of bits too."""

import pytest
from twins import twins

from opsim.engine.rules import ALLOCATION_RULES
from opsim.log import WALK, WORK

N_WORKERS = 7
SHORT, LONG = 9, 130
"""Stations: some, and more than two words of 64."""


def hall(n_stations: int, *, rule: str, idle: str, priority: bool) -> str:
    """Jobs that come in bursts to stations here and there, of people who can each do a third of them."""
    ranks = range(n_stations)
    first = ", priority: 2" if priority else ""
    skills = [{f"s{s}": 1 + (s * w) % 3 / 4 for s in ranks if (s + w) % 3 == 0} for w in range(N_WORKERS)]
    rounds = [", patrol: [" + ", ".join(able) + "]" if idle == "patrol" else "" for able in skills]
    return "\n".join(
        [
            "opsim: 1",
            "name: hall",
            "run: {horizon: 25 min, seed: 8}",
            "layout: {places: {" + ", ".join(f"p{i}: [{i % 4} m, {i // 8} m]" for i in ranks) + "}}",
            "tasks: {t: {dist: exponential, mean: 20 s}}",
            "stations:",
            *(f"  s{i}: {{at: p{i // 6}, tasks: [t], servers: 2{'' if i % 5 else first}}}" for i in ranks),
            "products:",
            *(f"  q{i}: {{route: [s{i}, s{(5 * i + 3) % n_stations}]}}" for i in ranks),
            "sources:",
            *(f"  from{i}: {{kind: poisson, every: {n_stations * 16} s, products: [q{i}]}}" for i in ranks),
            "workers:",
            *(f"  w{w}: {{skills: {skills[w]}{rounds[w]}}}".replace("'", "") for w in range(N_WORKERS)),
            f"allocation: {{rule: {rule}, idle: {idle}}}",
        ]
    )


@pytest.mark.parametrize("n_stations", [SHORT, LONG])
@pytest.mark.parametrize("rule", ALLOCATION_RULES)
def test_the_same_people_go_to_the_same_stations(rule, n_stations):
    log = twins(hall(n_stations, rule=rule, idle="stay", priority=False))
    assert len(set(log.of(WORK)["worker"])) == N_WORKERS
    assert len(set(log.of(WORK)["station"])) > n_stations / 2


@pytest.mark.parametrize("idle", ["stay", "home", "patrol"])
@pytest.mark.parametrize("n_stations", [SHORT, LONG])
def test_what_blocks_put_before_the_rule_and_who_is_idle(idle, n_stations):
    log = twins(hall(n_stations, rule="longest_queue", idle=idle, priority=True))
    assert len(log.of(WALK)) > 20
