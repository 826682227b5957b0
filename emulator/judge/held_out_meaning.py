"""What is told of a drawer that is held against unseen repetitions, and what each figure means."""

from __future__ import annotations

from dataclasses import dataclass

NONE = float("nan")


@dataclass(frozen=True)
class Figures:
    """How a drawer stands beside the unseen half; NaN for what it does not have. ``MEANING`` says what each is."""

    energy: float = NONE
    p: float = NONE
    novelty: float = NONE
    temporal_roughness: float = NONE
    roughness: float = NONE
    error: float = NONE
    n_numbers: float = NONE
    log_likelihood: float = NONE
    log_likelihood_drawn: float = NONE
    duration_p: float = NONE
    marks_p: float = NONE
    outside_percent: float = NONE
    top_speed_m_per_s: float = NONE
    skate_cm: float = NONE


MEANING = {
    "energy": "energy distance of draws to the unseen half, over that of as many recordings; 1 is real",
    "p": "of DISCO, as many drawn as unseen (middle split); low where draws are told from the unseen half",
    "novelty": "distance to the nearest fitted recording over that of unseen ones; 1 is honest, near 0 a copy",
    "temporal_roughness": "way from posture to posture over that of the unseen half; 1 is as smooth",
    "roughness": "second differences over those of the unseen half, where trembling shows first",
    "error": "what the scheme's numbers lose of the unseen half: radians, summed over bones, mean over time",
    "n_numbers": "numbers that say one sequence of postures",
    "log_likelihood": "of the unseen half, nats a repetition; schemes compare only where numbers mean the same",
    "log_likelihood_drawn": "of the scheme's own draws; unseen ones far below it: the scheme is too narrow",
    "duration_p": "Kolmogorov-Smirnov p of durations, Holm over durations and marks (middle split)",
    "marks_p": "the same of the mark that fits least",
    "outside_percent": "share of frames with any joint beyond its limit; skin markers put recorded ones there, too",
    "top_speed_m_per_s": "highest joint speed among as many performances as the fitted half has",
    "skate_cm": "way of a planted foot over the floor in a performance",
}
MIDDLE = ("p", "duration_p", "marks_p")
"""Figures of which the middle of the splits is told, not the mean."""
