"""What the replications of a study are made from: small enough to be sent to any process."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Source:
    """A scenario file and what all points of a study share.

    file    : the scenario file, or the name of a shipped one; every process that computes must be able to read it
    seed    : instead of the scenario's own
    kpis    : names of the figures that are kept of each replication, with all their subjects and parts
    changes : dotted paths and plain YAML values laid over every point, such as {"run.horizon": "4 h"}
    """

    file: str
    kpis: tuple[str, ...]
    seed: int | None = None
    changes: Mapping[str, Any] = field(default_factory=dict)
