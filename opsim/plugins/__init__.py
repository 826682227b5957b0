"""Parts that others install: found by entry points, loaded when asked for, blamed by name for their own mistakes.

| group | an entry point names |
|---|---|
| ``opsim.emulators`` | a callable that takes parameters by name and gives a TaskModel (``opsim/task_model.py``) |
| ``opsim.dispatch`` | a rule: a callable with the arguments of those in ``engine/rules.py``, giving a key |
| ``opsim.sequencing`` | which waiting job is next, by ``flow.dispatch``: as those in ``engine/rules.py`` |
| ``opsim.routing`` | which of several stations it goes to, by ``flow.routing``: those in ``engine/rules.py`` |
| ``opsim.rotation`` | who takes a post, by the ``rule`` of a rotation: as those in ``engine/rules.py`` |
| ``opsim.stations`` | a callable that takes parameters by name and gives the block of a station as a scenario has it |
| ``opsim.subjects`` | a subject of the floor, by its key in a scenario: a ``Subject`` (``opsim/plugins/subjects.py``) |
| ``opsim.human`` | nothing yet; the name is kept free |

Our own distributions and rules are registered in the same groups. A parameter whose name ends in ``_s``, ``_m``,
``_kg`` or ``_m_per_s`` is written in a scenario without that ending and with its unit: ``reach_m`` is ``reach: 40 cm``.
A callable that is given a value it cannot take raises ValueError: that is the user's mistake; anything else is its own.
"""

from importlib import import_module
from typing import Any

_HOMES = {
    "NoSuchPlugin": "opsim.problems",
    "PluginError": "opsim.problems",
    "Subject": "opsim.plugins.subjects",
    "dispatch_rule": "opsim.plugins.registry",
    "plugin_model": "opsim.plugins.registry",
    "plugin_problems": "opsim.plugins.registry",
    "plugins": "opsim.plugins.registry",
    "rule_of": "opsim.plugins.registry",
}
__all__ = [
    "NoSuchPlugin",
    "PluginError",
    "Subject",
    "dispatch_rule",
    "plugin_model",
    "plugin_problems",
    "plugins",
    "rule_of",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"opsim.plugins has no {name!r}")
    return getattr(import_module(_HOMES[name]), name)
