"""Models of human effects as they are: rules ask them by the names of their methods."""

from typing import Any


def refuse_strangers(_plan: Any) -> None:
    """None is refused."""


def model_of(_build: Any, model: Any) -> Any:
    """The model itself."""
    return model
