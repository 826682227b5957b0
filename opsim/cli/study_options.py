"""The options that all verbs of studies have."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import Any

import click

from opsim.cli.engine_option import engine_option
from opsim.engine.choice import SIMPY

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
