"""Whose mistake it is: a plug-in that fails is named with its distribution, entry point, file and exception."""

from __future__ import annotations

import linecache
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from traceback import walk_tb
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

OURS = "opsim"


class PluginError(ValueError):
    """A plug-in's own mistake; the text says which one, what it was doing, and where."""


class NoSuchPlugin(ValueError, KeyError):
    """A name that no installed plug-in has; the text holds the nearest that there is."""

    __str__ = Exception.__str__


@dataclass(frozen=True)
class Found:
    """An entry point that was found; nothing of it is imported yet."""

    entry_point: EntryPoint

    @property
    def distribution(self) -> str:
        """Name and version of what was installed, e.g. ``opsim-example-plugin 0.1.0``."""
        dist = self.entry_point.dist
        return "an unknown distribution" if dist is None else f"{dist.name} {dist.version}"

    @property
    def is_ours(self) -> bool:
        return self.entry_point.dist is not None and self.entry_point.dist.name == OURS

    def __str__(self) -> str:
        point = self.entry_point
        return f"{self.distribution} ({point.group}: {point.name} = {point.value})"


def fault(found: Found, what: str, place: str = "") -> PluginError:
    """The error of a plug-in that does what it should not."""
    point = found.entry_point
    lines = [f"plug-in {point.name!r} of {found.distribution}: {what}", place or _file_of(found)]
    lines.append(f"entry point {point.group}: {point.name} = {point.value}")
    return PluginError("\n  ".join(line for line in lines if line))


@contextmanager
def blamed(found: Found, doing: str) -> Iterator[None]:
    """What goes wrong inside is the plug-in's mistake. Ctrl-C is nobody's."""
    try:
        yield
    except PluginError:
        raise
    except (Exception, SystemExit) as error:
        raise fault(found, f"{doing}: {type(error).__name__}: {error}", _place(found, error)) from error


def _place(found: Found, error: BaseException) -> str:
    """File, line and source of the plug-in's innermost frame, or of the text that does not parse."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}: {(error.text or '').strip()}"
    package = found.entry_point.module.partition(".")[0]
    for frame, line in reversed(list(walk_tb(error.__traceback__))):
        if str(frame.f_globals.get("__name__", "")).partition(".")[0] == package:
            file = frame.f_code.co_filename
            return f"{file}:{line}: {linecache.getline(file, line).strip()}"
    return ""


def _file_of(found: Found) -> str:
    """The file of the module that the entry point names, where it could be imported."""
    return getattr(sys.modules.get(found.entry_point.module), "__file__", None) or ""
