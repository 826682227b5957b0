"""Queues and lines whose answer theory knows, simulated at seeds fixed beforehand.

Expected: M/M/1 at load 0.8, W = 5 and L = 4; saturated exponential lines with blocking after service, two stations
(B + 2) / (B + 3) (Hunt 1956), three stations without buffers 22 / 39 (Hillier & Boling 1967).
"""

import pytest
from plans import line, plan, queue

from opsim.laws import audit
from opsim.engine.simpy_engine import run_plan
from opsim.kpi import figures
from opsim.study.interval import t_interval

REPLICATIONS = 20
CASES = {
    "M/M/1 W": ("queue", "time_in_system_s", 5.0, 0.02),
    "M/M/1 L": ("queue", "work_in_progress", 4.0, 0.02),
    "two stations, B = 0": ("line 2 0", "throughput_per_h", 3600 * 2 / 3, 0.01),
    "two stations, B = 2": ("line 2 2", "throughput_per_h", 3600 * 4 / 5, 0.01),
    "two stations, B = 5": ("line 2 5", "throughput_per_h", 3600 * 7 / 8, 0.01),
    "three stations, B = 0": ("line 3 0", "throughput_per_h", 3600 * 22 / 39, 0.01),
}
SCENARIOS = {
    "queue": queue(horizon="100000 s", warm_up="2000 s", seed=2026),
    "line 2 0": line(2, 0, horizon="5000 s", seed=2026),
    "line 2 2": line(2, 2, horizon="5000 s", seed=2027),
    "line 2 5": line(2, 5, horizon="5000 s", seed=2028),
    "line 3 0": line(3, 0, horizon="5000 s", seed=2029),
}


def simulated(text):
    p = plan(text)
    values: dict[str, list[float]] = {}
    for replication in range(REPLICATIONS):
        log = run_plan(p, replication)
        audit(log, p)
        for figure in figures(log, p):
            if not figure.subject:
                values.setdefault(figure.kpi, []).append(figure.value)
    return values


@pytest.mark.slow
def test_theory_lies_in_the_intervals(capsys):
    found = {name: simulated(text) for name, text in SCENARIOS.items()}
    outside_95 = []
    for name, (scenario, kpi, expected, most_half_width) in CASES.items():
        values = found[scenario][kpi]
        narrow, wide = t_interval(values, 0.95), t_interval(values, 0.999)
        with capsys.disabled():
            print(f"\n{name:22} theory {expected:9.4f}  {narrow.mean:9.4f} +- {narrow.half_width:.4f}", end="")
        assert narrow.half_width <= most_half_width * narrow.mean, name
        assert wide.low <= expected <= wide.high, name
        if not narrow.low <= expected <= narrow.high:
            outside_95.append(name)
    assert len(outside_95) <= 1, outside_95
