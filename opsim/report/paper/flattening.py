"""Figures 4, 5, 7, 8, 9, 10 and 13, drawn from plain arrays (see ``emulator.judge.paper``)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from opsim.report.paper.drawing import dots, figure, legend, said, style, svg
from opsim.report.paper.write import Picture

N_BINS, N_BARS, CLOCK = 12, 15, "point of the common clock"


def figure_4(shown: Mapping[str, np.ndarray]) -> Picture:
    """shown : name -> (2, T, 3)."""
    drawn, axes = figure(2, 2)
    for row, (name, channels) in enumerate(shown.items()):
        for i in range(2):
            for k in range(channels.shape[-1]):
                axes[2 * row + i].plot(channels[i, :, k], **style(k))
            said(axes[2 * row + i], f"{name}, repetition {i + 1}", CLOCK, "radians")
    caption = "velocity fields brought to one posture, and their integrals: the three liveliest channels"
    return Picture(4, caption, svg(drawn))


def figure_5(errors: Mapping[str, np.ndarray]) -> Picture:
    """errors : name -> (T,)."""
    drawn, (axes,) = figure(1, 1, 7.0)
    for i, (name, error) in enumerate(errors.items()):
        axes.semilogy(np.maximum(error, 1e-17), label=name, **style(i))
    said(axes, "there and back again", CLOCK, "error, radians (sum of arcs)")
    legend(axes)
    return Picture(5, "error of flattening and its way back; the paper's floor of 1e-7 is its arccos", svg(drawn))


def figure_7(shares: Mapping[str, np.ndarray]) -> Picture:
    """shares : name -> share of each component."""
    drawn, axes = figure(len(shares))
    for one, (name, share) in zip(axes, shares.items()):
        one.bar(np.arange(1, len(share[:N_BARS]) + 1), share[:N_BARS], color="#0072B2")
        said(one, f"{name}: share of the variance in space", "component", "share")
    return Picture(7, "spatial PCA: how much of the variance each component carries", svg(drawn))


def figure_8(scores: np.ndarray, functions: np.ndarray, shares: np.ndarray) -> Picture:
    """scores (N, T), functions (3, T), shares of all functions."""
    drawn, axes = figure(3)
    axes[0].plot(scores.T, color="#9aa3ad", lw=0.5)
    axes[0].plot(scores.mean(axis=0), color="#0072B2", lw=2)
    said(axes[0], "first spatial score and its mean", CLOCK, "radians")
    for k, function in enumerate(functions):
        axes[1].plot(function, **style(k), label=f"function {k + 1}")
    said(axes[1], "first functions of time", CLOCK, "")
    legend(axes[1])
    axes[2].bar(np.arange(1, len(shares[:N_BARS]) + 1), shares[:N_BARS], color="#0072B2")
    said(axes[2], "share of the variance", "function", "share")
    return Picture(8, "functional PCA of the first spatial score (SIEM)", svg(drawn))


def figure_9(errors: Mapping[str, tuple[Sequence[int], Sequence[float]]]) -> Picture:
    """errors : reduction -> numbers a sequence, errors."""
    drawn, (axes,) = figure(1, 1, 7.0)
    for i, (name, (numbers, error)) in enumerate(errors.items()):
        axes.plot(numbers, error, marker="o", ms=3, label=name, **style(i))
    axes.set_xscale("log")
    said(axes, "of the sequences that were fitted", "numbers a sequence", "error, radians (eq. 5)")
    legend(axes)
    return Picture(9, "reconstruction error against the numbers that say a sequence", svg(drawn))


def figure_10(coefficients: np.ndarray) -> Picture:
    """coefficients (N, 2, 4)."""
    drawn, axes = figure(4, 2, 2.6, 2.0)
    for k, one in enumerate(axes):
        x = coefficients[:, k // 4, k % 4]
        one.hist(x, bins=N_BINS, density=True, color="#b7cfe3")
        grid, sd = np.linspace(x.min(), x.max(), 100), max(float(x.std()), 1e-12)
        one.plot(grid, np.exp(-0.5 * ((grid - x.mean()) / sd) ** 2) / (sd * np.sqrt(2 * np.pi)), color="#D55E00")
        said(one, f"score {k // 4 + 1}, function {k % 4 + 1}", "", "")
    return Picture(10, "coefficients of SIEM/SequentialPCA and one Gaussian each", svg(drawn))


def figure_13(widths: Sequence[int], errors: Mapping[int, Sequence[float]], p: Sequence[float]) -> Picture:
    """widths : d2; errors : by d1; p for the last d1."""
    drawn, axes = figure(2)
    for i, (d1, error) in enumerate(errors.items()):
        axes[0].plot(widths, error, label=f"d1 = {d1}", **style(i))
    said(axes[0], "reconstruction error", "d2", "radians (eq. 5)")
    legend(axes[0])
    axes[1].scatter(widths, p, **dots(0))
    axes[1].set_ylim(0, 1.05)
    said(axes[1], "reconstructed against original, d1 = 10", "d2", "p")
    return Picture(13, "choosing the dimensions: error, and two-sample test of what is reconstructed", svg(drawn))
