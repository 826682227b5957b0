"""What a verb gives so that its study can be run, gone on with, split over machines and put together again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from opsim.report.study_page import StudyPage
    from opsim.scenario.read import Loaded
    from opsim.scenario.varied import Varied
    from opsim.study.jobs import Answers, Source

KINDS = {"sweep": "sweep", "select": "select", "labour": "labour", "layout": "layout", "long-run": "long_run"}
"""Kind of study -> module of opsim.cli that gives it as ``KIND``."""


@dataclass(frozen=True)
class Asked:
    """What is asked of a study: everything that it may depend on beside its answers.

    variant      : the name of the variant to start from; ``varied`` makes scenarios of it, ``loaded`` is it unchanged
                   (but for the study's own changes, such as --horizon)
    block        : what stands in the scenario under ``studies:``, with options laid over it; None for a kind without
    plain        : the same as plain YAML values
    replications : as the command line, the block or the scenario says, in this order
    """

    varied: Varied
    loaded: Loaded
    variant: str
    block: Any
    plain: Mapping[str, Any]
    source: Source
    replications: int


@dataclass(frozen=True)
class Told:
    """What came out: ``summary`` for machines (summary.json, behind a head that is the same for all), ``page``."""

    summary: Mapping[str, Any]
    page: StudyPage


@dataclass(frozen=True)
class Kind:
    """A kind of study.

    study     : a pure function of what is asked and its answers; named streams are its only randomness
    kept      : names of the figures that are kept of each replication
    no_shards : why its jobs cannot be split beforehand; empty where they can. Then the first ``ensure`` or ``values``
                asks for all jobs at once
    """

    name: str
    study: Callable[[Asked, Answers], Told]
    kept: Callable[[Asked], Sequence[str]]
    no_shards: str = ""


def kind_of(name: str) -> Kind:
    """The kind of study of that name. Raises ValueError."""
    if name not in KINDS:
        raise ValueError(f"no kind of study {name!r}; known: {', '.join(KINDS)}")
    kind: Kind = import_module(f"opsim.cli.{KINDS[name]}").KIND
    return kind
