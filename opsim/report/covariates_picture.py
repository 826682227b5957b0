"""Histograms of how well bodies foretell joint angles: figures 4 and 5 of Baydal-Bertomeu et al., as SVG or PNG."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from opsim.report.palette import ACCENT, GRID, INK, MUTED
from opsim.whole import whole_file

N_BARS = 20
ICC_OF_THE_PAPER, SEM_OF_THE_PAPER = (0.91, 0.829, 0.971), (4.16, 0.41, 14.23)
"""Mean, 5th and 95th percentile that the paper reports for 18 runners."""


def draw_agreement(validation: Any, path: str | Path) -> Path:
    """ICC of people and SEM of joint angles, by body filled and by the others' mean as outline, the paper's range grey.

    validation : with ``task``, ``by_body`` and ``by_mean``, each with ``person_icc`` (W,) and ``sem_deg`` (W, A)
    path       : ends in .svg or .png
    """
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    path = Path(path)
    style: Any = {"svg.fonttype": "none", "svg.hashsalt": "opsim", "text.parse_math": False}
    with rc_context(style), whole_file(path) as temporary:
        figure = Figure(figsize=(9.0, 3.6), layout="constrained")
        title = f"{validation.task}: people left out, foretold from their bodies"
        figure.suptitle(title, x=0.01, ha="left", fontsize=11, color=INK)
        left, right = figure.subplots(1, 2)
        pairs = [(validation.by_body.person_icc, validation.by_mean.person_icc)]
        pairs.append((validation.by_body.sem_deg.ravel(), validation.by_mean.sem_deg.ravel()))
        _panel(left, *pairs[0], ICC_OF_THE_PAPER, "ICC(2,1) of a person, all joint angles", 3)
        _panel(right, *pairs[1], SEM_OF_THE_PAPER, "SEM of a joint angle, degrees", 2)
        right.legend(fontsize=8, frameon=False)
        kind = path.suffix.removeprefix(".").lower()
        figure.savefig(temporary, format=kind, dpi=150, metadata={"Date": None} if kind == "svg" else None)
    return path


def _panel(axes: Any, body: np.ndarray, mean: np.ndarray, paper: tuple[float, ...], label: str, digits: int) -> None:
    body, mean = body[np.isfinite(body)], mean[np.isfinite(mean)]
    edges = np.linspace(min(body.min(), mean.min(), paper[1]), max(body.max(), mean.max(), paper[2]), N_BARS + 1)
    axes.axvspan(paper[1], paper[2], color=MUTED, alpha=0.12, linewidth=0, label="paper, 5th to 95th percentile")
    axes.hist(body, edges, weights=np.full(body.size, 100 / body.size), color=ACCENT, label="by body")
    outline = np.full(mean.size, 100 / mean.size)
    axes.hist(mean, edges, weights=outline, histtype="step", color=INK, linewidth=1.2, label="by the others' mean")
    said = f"by body {body.mean():.{digits}f} ({body.std(ddof=1):.{digits}f}), paper {paper[0]:g}"
    axes.set_title(said, loc="left", fontsize=9, color=INK)
    axes.set_xlabel(label, fontsize=9, color=MUTED)
    axes.set_ylabel("per cent", fontsize=9, color=MUTED)
    axes.grid(color=GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)
