"""The options that all verbs of studies have.

What a verb gives so that its study can be run, gone on with, split over machines and put together again.

From a file and options to what is asked of a study; everything that is wrong with them is found here.

``--vary``: a path and its values, as text.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from opsim.cli.progress import engine_option
from opsim.engine import SIMPY
from opsim.problems import ScenarioError, shown

if TYPE_CHECKING:
    from opsim.report.page import StudyPage
    from opsim.scenario.schema.scenario import Loaded
    from opsim.scenario.study_checks import Varied
    from opsim.study.jobs import Answers, Source

COMPUTING = ("out", "shard", "processes", "executor", "engine", "overwrite", "as_json")
"""What says where and how a study is computed, not what is asked."""


@dataclass(frozen=True)
class Common:
    """What was said with them; ``words`` is the command without where and how it is computed."""

    out: Path | None = None
    scenario: str | None = None
    replications: int | None = None
    seed: int | None = None
    horizon: str | None = None
    processes: int | None = None
    executor: str | None = None
    engine: str = SIMPY
    shard: str | None = None
    overwrite: bool = False
    as_json: bool = False
    words: tuple[str, ...] = ()


def study_options(*, shards: bool = True) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a command the common options, as one argument ``common``.

    shards : whether its jobs are known beforehand; else --shard is not shown, and refused with the reason
    """
    added = (
        click.option("-o", "--out", type=click.Path(path_type=Path), help="Folder.  [default: results/<file>_<verb>]"),
        click.option("--scenario", metavar="NAME", help="The variant to start from.  [default: the first]"),
        click.option("--replications", type=click.IntRange(min=1), help="Instead of the file's own."),
        click.option("--seed", type=click.IntRange(min=0), help="Instead of the file's own."),
        click.option("--horizon", metavar="TIME", help="Instead of the file's own, such as '8 h'."),
        click.option("--processes", type=click.IntRange(min=1), help="Processes to use.  [default: as many as pay]"),
        click.option("--executor", metavar="dask:ADDRESS", help="Compute on a cluster, as dask:tcp://host:8786."),
        engine_option(),
        click.option("--shard", metavar="I/N", hidden=not shards, help="Only part I of N; 'opsim merge' joins them."),
        click.option("--overwrite", is_flag=True, help="Remove what the folder holds of another study (or this one)."),
        click.option("--json", "as_json", is_flag=True, help="JSON for machines."),
    )

    def with_options(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def called(**said: Any) -> Any:
            common = {one.name: said.pop(one.name) for one in fields(Common) if one.name != "words"}
            return command(common=Common(**common, words=typed(click.get_current_context())), **said)

        wrapped: Callable[..., Any] = called
        for option in reversed(added):
            wrapped = option(wrapped)
        return wrapped

    return with_options


def from_here(file: str) -> str:
    """The path from the working folder to a file that lies in it, however it was typed; any other as it was typed."""
    if not Path(file).is_file():
        return file  # a shipped scenario, by its name
    try:
        return Path(os.path.abspath(file)).relative_to(Path.cwd()).as_posix()
    except ValueError:
        return file


def typed(context: click.Context) -> tuple[str, ...]:
    """The words of a call that say what is asked, in one order however they were typed."""
    words = [context.info_name or ""]
    for parameter in context.command.params:
        name, value = parameter.name or "", context.params.get(parameter.name or "")
        given = context.get_parameter_source(name) == click.core.ParameterSource.COMMANDLINE
        if given and name not in COMPUTING:
            words += _words(parameter, value)
    return tuple(words)


def _words(parameter: click.Parameter, value: Any) -> list[str]:
    values = list(value) if isinstance(value, tuple) else [value]
    if isinstance(parameter, click.Argument):
        return [from_here(str(one)) if parameter.name == "file" else str(one) for one in values]
    option = max(parameter.opts, key=len)
    if isinstance(parameter, click.Option) and parameter.is_flag:
        return [option] if value else list(parameter.secondary_opts[:1])
    return [word for one in values for word in (option, str(one))]


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


def asked_by_user(kind: Kind, file: str, common: Common, options: Mapping[str, Any]) -> Asked:
    """options : keys of the kind's block -> plain values; None, (), False where nothing was said

    Raises ScenarioError, ValueError, OSError.
    """
    from opsim.scenario.study_checks import Varied
    from opsim.scenario.tree import child

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
    from opsim.scenario.study_checks import check_study
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
    from opsim.scenario.study_checks import Varied
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


EXAMPLE = "such as 'release.every=40 s..60 s' or 'stations.saw.buffer=1,2,4'"
_DOTS = r"\s*\.\.\s*"


def vary_of(texts: Sequence[str]) -> dict[str, Any]:
    """``["release.every=40 s..60 s"]`` -> {"release.every": {"from": "40 s", "to": "60 s"}}, as a file would have it.

    Raises ValueError with all mistakes, a line each.
    """
    found: dict[str, Any] = {}
    wrong = []
    for text in texts:
        path, equals, values = (part.strip() for part in text.partition("="))
        try:
            if not path or not equals or not values:
                raise ValueError(f"expected a path, '=' and values; {EXAMPLE}")
            if path in found:
                raise ValueError(f"{path} is given twice; give all of its values at once")
            found[path] = _values(values)
        except ValueError as error:
            wrong.append(f"--vary {shown(text)}: {error}")
    if wrong:
        raise ValueError("\n".join(wrong))
    return found


def _values(text: str) -> Any:
    """A range, or a list of values as YAML has them between brackets."""
    ends = re.split(_DOTS, text)
    if len(ends) == 1:
        return _yaml(f"[{text}]")
    if len(ends) > 2 or not all(ends):
        raise ValueError(f"a range has two ends, found {shown(text)}; {EXAMPLE}")
    low, high = (_yaml(f"[{end}]") for end in ends)
    if len(low) != 1 or len(high) != 1:
        raise ValueError(f"a range has one value at each end, found {shown(text)}; {EXAMPLE}")
    return {"from": low[0], "to": high[0]}


def _yaml(text: str) -> list[Any]:
    from opsim.scenario.yaml import read_tree

    try:
        tree, problems = read_tree(f"values: {text}".encode(), "--vary")
    except ScenarioError as error:
        problems = list(error.problems)
    if problems:
        raise ValueError(f"cannot be read as values: {problems[0].message}")
    plain: Any = tree.plain()
    values: list[Any] = plain["values"]
    return values
