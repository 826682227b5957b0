"""Naive twins of the kernels: the definitions, written to be read, never to be fast."""

from fractions import Fraction
from itertools import pairwise
from math import gcd

import numpy as np


def naive_edge(q1, q2, start, end):
    """The integral over the edge of <q1(t), q2(gamma(t))> sqrt(gamma'), by overlaying both step functions."""
    (i0, j0), (i1, j1) = start, end
    slope = Fraction(j1 - j0, i1 - i0)
    cuts = {Fraction(i) for i in range(i0, i1 + 1)} | {i0 + (Fraction(j) - j0) / slope for j in range(j0, j1 + 1)}
    total = 0.0
    ordered = sorted(cuts)
    for low, high in pairwise(ordered):
        middle = (low + high) / 2
        t_cell, gamma_cell = int(middle), int(j0 + (middle - i0) * slope)
        total += float(high - low) * float(np.dot(q1[t_cell], q2[gamma_cell]))
    return total * float(slope) ** 0.5


def naive_elastic(q1, q2, steepest=7):
    """The largest inner product over all paths of coprime moves, node by node: (optimum, best path)."""
    n, m = len(q1), len(q2)
    moves = [(p, q) for p in range(1, steepest + 1) for q in range(1, steepest + 1) if gcd(p, q) == 1]
    best, came_from = {(0, 0): 0.0}, {}
    for i in range(1, n + 1):
        for j in range(1, m + 1):
            for p, q in moves:
                earlier = (i - p, j - q)
                if earlier in best:
                    value = best[earlier] + naive_edge(q1, q2, earlier, (i, j))
                    if value > best.get((i, j), -np.inf):
                        best[i, j], came_from[i, j] = value, earlier
    path = [(n, m)]
    while path[-1] in came_from:
        path.append(came_from[path[-1]])
    return best[n, m] / n, np.array(path[::-1])


def naive_tsrvf(directions, reference):
    """S-TSRVF of one sequence (T, B, 3), bone by bone: velocity carried to the reference, over the root of its norm."""
    steps = len(directions) - 1
    field = np.zeros((steps, directions.shape[1], 3))
    for t in range(steps):
        for b, target in enumerate(reference):
            here, there = directions[t, b], directions[t + 1, b]
            angle = np.arctan2(np.linalg.norm(np.cross(here, there)), here @ there)
            across = there - (here @ there) * here
            length = np.linalg.norm(across)
            velocity = across / length * angle * steps if length > 0 else np.zeros(3)
            field[t, b] = velocity - (velocity @ target) / (1 + here @ target) * (here + target)
        speed = np.linalg.norm(field[t])
        field[t] = field[t] / np.sqrt(speed) if speed > 0 else 0.0
    return field.reshape(steps, -1)


def naive_positions(parents, directions, lengths, root):
    """Joint positions of one posture, walking down from the root."""
    bones = [j for j, parent in enumerate(parents) if parent >= 0]
    places = {parents.index(-1): np.asarray(root, float)}
    while len(places) < len(parents):
        for b, joint in enumerate(bones):
            if parents[joint] in places and joint not in places:
                places[joint] = places[parents[joint]] + lengths[b] * directions[b]
    return np.array([places[j] for j in range(len(parents))])
