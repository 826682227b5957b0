"""Anything at all in the blocks of hands, scoring, human effects and the frontier: read, or refused with a place."""

from copy import deepcopy
from pathlib import Path

import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from opsim.human.catalogue import catalogue
from opsim.plan import compile_plan
from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from opsim.scenario.warnings import risks_of
from opsim.study.assumptions.sheet import assumptions_of

HERE = Path(__file__).parent
EVERYTHING, GOOD = (
    yaml.safe_load((HERE / f"{name}.yaml").read_text(encoding="utf-8")) for name in ("everything", "good")
)
NEW = {key: EVERYTHING[key] for key in ("ergonomics", "human", "frontier")}
SMALL = {
    **{key: block for key, block in GOOD.items() if key not in ("overrides", "scenarios")},
    **NEW,
    "run": {**GOOD["run"], "posture": "on"},
    "tasks": {"lift": EVERYTHING["tasks"]["lift"]},
    "workers": {"ana": {"skills": {"pack": 1.1}, "experience": {"lift": 200}}},
}
BLOCKS = (
    ("ergonomics",),
    ("human",),
    ("frontier",),
    ("run", "posture"),
    ("tasks", "lift", "handling"),
    ("tasks", "lift", "loaded"),
    ("tasks", "lift", "load"),
    ("workers", "ana", "experience"),
)
MODELS = [{"human": {**EVERYTHING["human"], one.effect: {"model": one.model}}} for one in catalogue()]
TEXTS = st.sampled_from(
    ["10 deg", "-1 deg", "1 kg", "1 s", "never", "16:00", "off", "grasp", "wright", "less x", "nan"]
)
ODD = st.none() | st.booleans() | st.integers() | st.floats() | TEXTS | st.text(max_size=4)
SOME = (
    ODD
    | st.lists(ODD, max_size=3)
    | st.dictionaries(st.sampled_from(["model", "rate", "twist"]) | st.text(), ODD, max_size=3)
)


def read_or_refuse(tree):
    try:
        read = scenarios_in(yaml.safe_dump(tree, allow_unicode=True).encode(), Path("line.yaml"))
    except ScenarioError as error:
        assert all(one.line and one.message for one in error.problems)
        return
    for loaded in read.values():
        assert all(isinstance(risk, str) for risk in risks_of(loaded.scenario))
        assert assumptions_of(loaded, compile_plan(loaded))


@settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow], deadline=None)
@given(data=st.data())
def test_anything_in_these_blocks_is_planned_or_refused(data):
    tree = deepcopy(SMALL | data.draw(st.sampled_from(MODELS)))
    *way, key = data.draw(st.sampled_from(BLOCKS))
    parent = tree
    for part in way:
        parent = parent[part]
    while isinstance(parent[key], dict | list) and parent[key] and data.draw(st.booleans()):
        parent = parent[key]
        key = data.draw(st.sampled_from(sorted(parent) if isinstance(parent, dict) else range(len(parent))))
    if isinstance(parent, dict) and data.draw(st.booleans()):
        key = data.draw(st.just(key) | st.text(max_size=4))
    parent[key] = data.draw(SOME)
    read_or_refuse(tree)
