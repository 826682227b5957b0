"""Random paced lines with everything that a station of one may have: laws hold, and the order of declaration decides
nothing.
"""

from collections import Counter
from random import Random

import numpy as np
import pytest
import yaml
from made_lines import line_scenario

from opsim.engine.floor import run_plan
from opsim.kpi.table import figures
from opsim.laws import CHECKS, audit
from opsim.log import COLUMNS, FINISH, JOB_KINDS, SENT_ON, STANDS
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in

SECTIONS = ("tasks", "stations", "products", "sources", "workers", "shifts", "tools")


def planned(values, folder):
    text = yaml.safe_dump(values, sort_keys=False)
    return compile_plan(scenarios_in(text.encode(), folder / "line.yaml")["base"])


def shuffled(values, seed):
    pick, found = Random(seed), dict(values)
    for section in SECTIONS:
        names = list(values.get(section, {}))
        pick.shuffle(names)
        found |= {section: {name: values[section][name] for name in names}} if names else {}
    return found


def checked(seed, folder):
    values = line_scenario(seed)
    p = planned(values, folder)
    log = run_plan(p)
    assert audit(log, p) == CHECKS, seed
    assert all(not figure.value < -1e-9 for figure in figures(log, p)), seed
    again = run_plan(planned(shuffled(values, seed), folder))
    assert len(log) == len(again), seed
    assert all(np.array_equal(log[c], again[c], equal_nan=log[c].dtype.kind == "f") for c in COLUMNS), seed
    return log, p


def apart_s(log, p):
    """The least time between two jobs coming onto the line."""
    (line,) = p.lines
    here = np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] == line.stations[0])
    rows = log.where(here)
    first = [rows["start_s"][rows["job"] == job].min() for job in np.unique(rows["job"])]
    return np.diff(np.sort(first)).min(initial=np.inf)


@pytest.mark.parametrize("seed", range(8))
def test_a_few_random_lines_obey_the_laws(seed, tmp_path):
    log, p = checked(seed, tmp_path)
    assert apart_s(log, p) >= p.lines[0].takt_s


@pytest.mark.slow
def test_random_lines_obey_the_laws_and_show_what_lines_do(tmp_path):
    seen: Counter[str] = Counter()
    for seed in range(8, 300):
        log, p = checked(seed, tmp_path)
        (line,) = p.lines
        assert apart_s(log, p) >= line.takt_s, seed
        seen.update({f"{line.kind} {'sends on' if line.sends_on else 'stops'}"} if len(log.of(FINISH)) > 3 else ())
        seen.update({"sent on"} if len(log.of(SENT_ON)) else ())
        seen.update({f"stands: {log.names['cause'][cause]}" for cause in np.unique(log.of(STANDS)["cause"])})
        called = np.isin(log["worker"], line.floaters) & (log["task"] >= 0)
        seen.update({f"helps {line.helps}"} if np.any(called) else ())
    wanted = [f"{kind} {what}" for kind in ("indexed", "moving") for what in ("sends on", "stops")]
    wanted += [f"stands: {cause}" for cause in ("unfinished", "full", "down", "closed", "away")]
    wanted += ["sent on", "helps True", "helps False"]
    assert {name: seen[name] for name in wanted if seen[name] < 10} == {}
