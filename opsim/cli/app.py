"""A group of verbs that are imported when they are called; mistakes are answered in words, never with a traceback.

Ctrl-C and SIGTERM stop a run once and cleanly; what comes after the first is ignored while ends are tied up.

Tables for people and JSON for machines, both on stdout.
"""

from __future__ import annotations

import atexit
import math
import os
import signal
import sys
import threading
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

import click

from opsim.threads import freeze

INTERRUPTED = 130
EXTRAS = dict.fromkeys(("matplotlib", "PIL"), "'pip install opsim[matplotlib]'")
"""What not everybody has installed, by the module that is missed."""


class Mistake(click.ClickException):
    """A mistake of the user: said on stderr, exit code 2."""

    exit_code = 2

    def show(self, file: Any = None) -> None:
        click.echo(self.format_message(), err=True)


class Interrupted(click.ClickException):
    """Ctrl-C, with a word on what is kept."""

    exit_code = INTERRUPTED

    def show(self, file: Any = None) -> None:
        click.echo(self.format_message(), err=True)


class Verbs(click.Group):
    """``verbs`` maps each verb to the module whose ``command`` it is."""

    def __init__(self, *args: Any, verbs: Mapping[str, str], **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.verbs = dict(verbs)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """The verbs in the order of the work, not of the alphabet."""
        return list(self.verbs)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import the verb's module, now that it is wanted."""
        return import_module(self.verbs[cmd_name]).command if cmd_name in self.verbs else None

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """As click does, with the nearest verb where there is none such."""
        word = str(args[0])
        if word not in self.verbs and not word.startswith("-"):
            near = get_close_matches(word, self.verbs, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"known: {', '.join(self.verbs)}"
            ctx.fail(f"no verb {word!r}; {hint}")
        return super().resolve_command(ctx, args)

    def main(self, *args: Any, **kwargs: Any) -> NoReturn:
        """Run, and leave with 0, 2 for a user's mistake, 130 for Ctrl-C; a traceback means a bug of ours."""
        kwargs["standalone_mode"] = False
        atexit.register(freeze)
        try:
            code = super().main(*args, **kwargs)
        except click.ClickException as mistake:
            mistake.show()
            sys.exit(mistake.exit_code)
        except (click.Abort, KeyboardInterrupt):
            click.echo("stopped", err=True)
            sys.exit(INTERRUPTED)
        except ModuleNotFoundError as missing:
            if missing.name not in EXTRAS:
                raise
            click.echo(f"this needs {missing.name}, which is not installed; {EXTRAS[missing.name]} brings it", err=True)
            sys.exit(Mistake.exit_code)
        except BrokenPipeError:  # the reader of a pipe has gone, as with `| head`
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            sys.exit(1)
        sys.exit(code if isinstance(code, int) else 0)


@contextmanager
def mistakes(*only: type[Exception]) -> Iterator[None]:
    """What is wrong with the user's files, inside this block, is a Mistake. Set OPSIM_TRACEBACK=1 to see where.

    only : exceptions that are the user's doing; by default those of reading: ScenarioError, ValueError, OSError.
           A plug-in's own mistake is said in every case: who installed it can do something about it.
    """
    from opsim.problems import PluginError, ScenarioError

    kinds: tuple[type[Exception], ...] = (*(only or (ScenarioError, ValueError, OSError)), PluginError)
    try:
        yield
    except BrokenPipeError:
        raise
    except kinds as error:
        if os.environ.get("OPSIM_TRACEBACK"):
            raise
        raise Mistake(_said(error)) from None


def _said(error: Exception) -> str:
    if isinstance(error, FileExistsError) and error.filename:
        return f"{error.filename}: found a file, expected a folder to write into"
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error)


SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Terminated(Interrupted):
    """SIGTERM, with a word on what is kept."""

    exit_code = 143


class Stop(KeyboardInterrupt):
    """Somebody wants the run to end; ``number`` is that of the signal."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


@contextmanager
def stops_once() -> Iterator[None]:
    """The first Ctrl-C or SIGTERM in this block raises Stop; later ones do nothing, so that no traceback is left."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _stop) for number in SIGNALS}
    try:
        yield
    finally:
        if signal.getsignal(signal.SIGINT) is _stop:
            for number, handler in before.items():
                signal.signal(number, handler)


def _stop(number: int, _frame: Any) -> None:
    for each in SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    raise Stop(number)


def stopped(by: KeyboardInterrupt, kept: str) -> Interrupted:
    """What to raise after a stop, with a word on what is kept; its exit code tells Ctrl-C from SIGTERM."""
    terminated = isinstance(by, Stop) and by.number == signal.SIGTERM
    return (Terminated if terminated else Interrupted)(f"stopped; {kept}")


def held(out: Path, done: Collection[str], wanted: Sequence[str]) -> str:
    """In words, which of the tasks wanted are in ``out`` and which are not."""
    if not done:
        return "nothing was finished"
    return f"{out} holds {', '.join(done)}, not {', '.join(task for task in wanted if task not in done)}"


def written_so_far(written: Sequence[Path], wanted: Sequence[Path]) -> str:
    """In words, which of the files wanted were written and which were not."""
    if not written:
        return "nothing was written"
    missing = ", ".join(str(path) for path in wanted if path not in written)
    return f"written: {', '.join(map(str, written))}" + (f"; not written: {missing}" if missing else "")


PIPE_WIDTH = 140


def width() -> int:
    """Characters of the terminal; of what a pipe is given elsewhere."""
    from shutil import get_terminal_size

    return get_terminal_size().columns if sys.stdout.isatty() else PIPE_WIDTH


def say(sentence: str) -> None:
    """A sentence, broken between words on a terminal and in one line elsewhere; nothing in it steers a terminal."""
    from textwrap import fill

    text = printable(sentence)
    click.echo(fill(text, width(), break_long_words=False, break_on_hyphens=False) if sys.stdout.isatty() else text)


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[str]], *, words: int = 1) -> None:
    """A table; the first ``words`` columns are text, the others stand to the right. Nothing in it is read as markup.

    Characters that do not print, such as those that steer a terminal, become '?'.
    """
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console() if sys.stdout.isatty() else Console(width=PIPE_WIDTH)
    table = Table(title=Text(printable(title), style="bold"), title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for place, column in enumerate(columns):
        table.add_column(Text(printable(column)), justify="left" if place < words else "right", overflow="fold")
    for row in rows:
        table.add_row(*(Text(printable(cell)) for cell in row))
    console.print(table)


def printable(text: str) -> str:
    """The text without anything that a terminal would obey; a tab or a new line becomes a space."""
    return "".join(c if c.isprintable() else " " if c in "\t\n\r" else "?" for c in text)


def print_json(value: Any) -> None:
    """One JSON document; what is not a number is null."""
    import json

    click.echo(json.dumps(_plain(value), indent=1, ensure_ascii=False, allow_nan=False))


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
