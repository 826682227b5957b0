"""What is said where compiling takes longer than it has to, once for each kind of reason: results are the same."""

from __future__ import annotations

import warnings


class SlowCompiling(UserWarning):
    """The engine compiles in a slower way, or cannot keep what it has compiled."""


_SAID = set[str]()


def say(name: str, what: str, error: BaseException) -> None:
    """NOTE: once for each kind of error, not for each function: where numba is another one, all of them fail alike."""
    if type(error).__name__ + what not in _SAID:
        _SAID.add(type(error).__name__ + what)
        first = next(iter(str(error).splitlines()), "")
        warnings.warn(f"{name}: {what} ({type(error).__name__}: {first})", SlowCompiling, stacklevel=3)
