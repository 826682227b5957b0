"""Motion of any length, with contact: poses in a latent space, stepped through by switching Gaussian processes.

A table of contents: importing it does nothing; a name is loaded when it is asked for.
Source: Remillard & Kry (2010); what goes beyond it is said where it is done.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "GaussianProcess": "gaussian_process",
    "Hyper": "gaussian_process",
    "PoseLatent": "latent",
    "Poses": "latent",
    "StateClassifier": "gp_classifier",
    "SwitchingDynamics": "switching_dynamics",
    "contact_of": "contacts",
    "contact_of_state": "contacts",
    "found_states": "contacts",
    "path_of": "latent",
    "poses_of": "latent",
    "positions_of": "latent",
    "single_support": "contacts",
    "state_of_contact": "contacts",
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"emulator.cyclic.{_HOME[name]}"), name)
    raise AttributeError(f"emulator.cyclic has no {name!r}; it has {', '.join(__all__)}")


def __dir__() -> list[str]:
    return __all__
