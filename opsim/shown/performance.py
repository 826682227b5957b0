"""A performance in a notebook: whose, of what, how long, and the body that did it."""

from __future__ import annotations

from opsim.performance import Performance
from opsim.shown.html import sentence
from opsim.shown.pictures import bodies


def performance_html(one: Performance) -> str:
    """A sentence, and the body at some moments where there is one."""
    part = "" if (one.progress_from, one.progress_to) == (0.0, 1.0) else _part(one)
    words = (
        f"{one.worker}, {one.task}, performance {one.k}{part}: "
        f"{one.end_s - one.start_s:.2f} s from {one.start_s:.2f} s on."
    )
    skeleton = one.skeleton
    if skeleton is None or one.progress_to <= one.progress_from:
        return sentence("Performance:", words)
    return sentence("Performance:", words) + bodies(
        one.positions_m(n_times=6), skeleton.parents, f"{one.task}, the body"
    )


def _part(one: Performance) -> str:
    return f" ({one.progress_from:.0%} to {one.progress_to:.0%} of it)"
