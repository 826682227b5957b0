"""A group of verbs that are imported when they are called; mistakes are answered in words, never with a traceback."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from difflib import get_close_matches
from importlib import import_module
from typing import Any, NoReturn

import click

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
    from opsim.plugins.blame import PluginError
    from opsim.problems import ScenarioError

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
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error)
