"""What stands behind an emulator: recordings of people, or nobody at all."""

from typing import Any


def fit_report(model: Any) -> Any:
    """What an emulator tells of its training, beyond the seam: source, licence, n_sequences, n_workers."""
    return model.report


def is_made_up(source: str) -> bool:
    """Whether a library's source says that nobody was recorded."""
    return source.lower().startswith(("synthetic", "emulated"))


def behind(source: str, n_sequences: int, n_workers: int) -> str:
    """In words, e.g. ``41 recordings of 6 people``."""
    if is_made_up(source):
        return f"{n_sequences} made repetitions of {n_workers} made-up people: nobody was recorded"
    return f"{n_sequences} recordings of {n_workers} people"
