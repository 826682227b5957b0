"""Options of verbs that have another name in a scenario file: who writes the option there is told the key."""

from __future__ import annotations

from opsim.scenario.positions import Part

_IN_RUN = {"seed": "run.seed", "horizon": "run.horizon", "warm_up": "run.warm_up"}
_BUY_BACK = {key: f"buy_back.{key}" for key in ("like", "most_workers", "most_skills")}
_KEYS = {
    "sweep": {"figure": "figures"},
    "select": {"best": "figure", "among": "variants", "most": "most_replications"},
    "labour": {"figure": "figures", "no_budget": "budget: off", "no_buy_back": "buy_back: off", **_BUY_BACK},
    "layout": {},
}
"""By verb: an option, and where in the file it stands."""


def option_hint(path: tuple[Part, ...]) -> str:
    """What to write instead of an option among the keys of a study; empty where the key is none that an option has."""
    if len(path) != 3 or path[0] != "studies":
        return ""
    verb, word = str(path[1]), str(path[2]).strip("-").replace("-", "_")
    option = f"--{word.replace('_', '-')}"
    if verb in _KEYS and word in _IN_RUN:
        return f"{option} is {_IN_RUN[word]} in a file"
    key = _KEYS.get(verb, {}).get(word, "")
    if not key:
        return ""
    return f"the key of {option} is '{key}'" if key.isidentifier() else f"{option} is {key} in a file"
