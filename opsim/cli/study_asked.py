"""From a file and options to what is asked of a study; everything that is wrong with them is found here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from opsim.cli.study_kind import Asked, Kind
from opsim.cli.study_options import Common


def asked_by_user(kind: Kind, file: str, common: Common, options: Mapping[str, Any]) -> Asked:
    """options : keys of the kind's block -> plain values; None, (), False where nothing was said

    Raises ScenarioError, ValueError, OSError.
    """
    from opsim.scenario.positions import child
    from opsim.scenario.varied import Varied

    varied = Varied.read(file, common.scenario)
    said = {
        key: _plain(value) for key, value in options.items() if value is not None and value is not False and value != ()
    }
    fields = _fields(kind)
    if common.replications is not None and "replications" in fields:
        said["replications"] = common.replications
    laid = {f"studies.{kind.name}.{key}": value for key, value in said.items()}
    if fields and not laid and child(varied.tree, "studies", kind.name) is None:
        laid = {f"studies.{kind.name}": {}}
    changes = {} if common.horizon is None else {"run.horizon": common.horizon}
    return asked_of(kind, varied, file, common.seed, changes, laid, common.replications)


def asked_of(
    kind: Kind,
    varied: Any,
    file: str,
    seed: int | None,
    changes: Mapping[str, Any],
    laid: Mapping[str, Any],
    n: int | None,
    origin: str = "command line",
) -> Asked:
    """changes : for every point of the study. laid : over the file's studies. n : replications, where they are said

    origin : where changes and laid come from. Raises ScenarioError, ValueError, OSError.
    """
    from opsim.scenario.studied import check_study
    from opsim.study.jobs import Source

    laid_over = varied.laid({**changes, **laid}, origin)
    check_study(laid_over, kind.name)
    loaded = laid_over.with_changes({})
    block = getattr(loaded.scenario.studies, kind.name, None)
    if twice := sorted(set(changes) & set(getattr(block, "vary", None) or ())):
        raise ValueError(f"{twice[0]} is given once for all ({changes[twice[0]]}) and is varied too; keep one of both")
    plain = (loaded.resolved.get("studies") or {}).get(kind.name) or {}
    own = getattr(block, "replications", None) or loaded.scenario.run.replications
    asked = Asked(varied, loaded, varied.variant, block, plain, Source(file, (), seed, dict(changes)), n or own)
    return replace(asked, source=replace(asked.source, kpis=tuple(dict.fromkeys(kind.kept(asked)))))


def asked_again(kind: Kind, header: Any, file: str | Path | None = None) -> Asked:
    """What was asked of a study that has a folder; file : where its scenario is now.

    Raises ScenarioError, ValueError, OSError.
    """
    from opsim.scenario.varied import Varied
    from opsim.study.jobs.header import HEADER

    source = header.source
    file = source.file if file is None else str(file)
    varied = Varied.read(file, header.variant)
    laid = {f"studies.{kind.name}": dict(header.asked)} if _fields(kind) else {}
    return asked_of(kind, varied, file, source.seed, source.changes, laid, header.replications, HEADER)


def header_for(kind: Kind, asked: Asked, words: tuple[str, ...], n: int | None) -> Any:
    """What stands in the study's folder. Raises ScenarioError, OSError."""
    from opsim.study.jobs.header import header_of

    return header_of(kind.name, asked.source, asked.variant, asked.plain, n, words)


def _fields(kind: Kind) -> Mapping[str, Any]:
    """The keys of the kind's block by name; empty for a kind without."""
    from opsim.scenario.schema.studies import Studies

    of = Studies.model_fields.get(kind.name)
    if of is None:
        return {}
    kinds = [one for one in getattr(of.annotation, "__args__", ()) if hasattr(one, "model_fields")]
    return {field.alias or name: field for name, field in kinds[0].model_fields.items()} or {"": None}


def _plain(value: Any) -> Any:
    return (
        [_plain(one) for one in value] if isinstance(value, tuple) else str(value) if isinstance(value, Path) else value
    )
