"""New frames onto the manifold and back, by the affine map of the neighbourhood they fall into.

Source: spatio-temporal LTSA (seed 003), sec. 2.4: what maps a frame's neighbours maps what lies close to it.
"""

from __future__ import annotations

import numpy as np

from emulator.segmenting.stltsa import Embedding


def to_manifold(embedding: Embedding, points: np.ndarray, near_frame: np.ndarray | None = None) -> np.ndarray:
    """Coordinates (p, d) of new points (p, m).

    near_frame : (p,) frames of the embedding, also between frames, that each lies next to in time;
                 None: the nearest in space is taken
    """
    nearest = _nearest(embedding.points, points, near_frame)
    return _mapped(embedding, points, nearest, embedding.points, embedding.coordinates, embedding.d)


def to_postures(embedding: Embedding, coordinates: np.ndarray, near_frame: np.ndarray | None = None) -> np.ndarray:
    """Points (p, m) of posture space at coordinates (p, d) on the manifold."""
    nearest = _nearest(embedding.coordinates, coordinates, near_frame)
    return _mapped(embedding, coordinates, nearest, embedding.coordinates, embedding.points, embedding.d)


def _nearest(known: np.ndarray, new: np.ndarray, near_frame: np.ndarray | None) -> np.ndarray:
    if near_frame is not None:
        return np.clip(np.rint(near_frame).astype(int), 0, len(known) - 1)
    from scipy.spatial import cKDTree

    return np.asarray(cKDTree(known).query(new)[1])


def _mapped(
    embedding: Embedding, new: np.ndarray, nearest: np.ndarray, source: np.ndarray, target: np.ndarray, d: int
) -> np.ndarray:
    """The least-squares affine map from ``source`` to ``target`` on each neighbourhood, through its own frame."""
    found = np.empty((len(new), target.shape[1]))
    for frame in np.unique(nearest):
        members = np.append(embedding.neighbours[frame], frame)
        here, there = source[members], target[members]
        left, size, right = np.linalg.svd(here - source[frame], full_matrices=False)
        keep = min(d, int(np.sum(size > 1e-10 * max(float(size[0]), 1e-300))))
        inverse = (left[:, :keep] / size[:keep]).T @ (there - target[frame])
        rows = nearest == frame
        found[rows] = target[frame] + (new[rows] - source[frame]) @ right[:keep].T @ inverse
    return found
