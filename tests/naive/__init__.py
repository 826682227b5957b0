"""Naive twins of the kernels: the definitions, written to be read, never to be fast."""

from fractions import Fraction
from itertools import pairwise, product
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


def naive_turn(axis, degrees):
    """The matrix that turns about "x", "y" or "z"."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def naive_hierarchy(parents, offsets, channels, frame):
    """Joints (J, 3) of one frame of a BVH hierarchy: a joint turns its children, position channels replace OFFSET."""
    values = iter(frame)
    places, turned = [], []
    for parent, offset, names in zip(parents, offsets, channels):
        step, turn = np.array(offset, float), np.eye(3)
        for name in names:
            if name.endswith("position"):
                step["XYZ".index(name[0])] = next(values)
            else:
                turn = turn @ naive_turn(name[0].lower(), next(values))
        places.append(step if parent < 0 else places[parent] + turned[parent] @ step)
        turned.append(turn if parent < 0 else turned[parent] @ turn)
    return np.array(places)


def naive_alignment(points, k, d, in_time=True):
    """The alignment matrix of spatio-temporal LTSA by its table 1, one neighbourhood after the other: (n, n)."""
    n = len(points)
    matrix = np.zeros((n, n))
    for i in range(n):
        candidates = [j for j in range(n) if j != i and (not in_time or abs(i - j) <= k)]
        apart = {j: np.sum((points[j] - points[i]) ** 2) for j in candidates}
        near = sorted(sorted(candidates, key=lambda j: apart[j])[:k])
        centred = points[near] - points[near].mean(axis=0)
        left = np.linalg.svd(centred, full_matrices=False)[0][:, :d]
        basis = np.column_stack([np.full(k, 1 / np.sqrt(k)), left])
        matrix[np.ix_(near, near)] += np.eye(k) - basis @ basis.T
    return matrix


def naive_covariance(x, other, length, signal):
    """The squared exponential kernel, pair by pair: (n, m)."""
    return np.array([[signal**2 * np.exp(-0.5 * sum(((a - b) / length) ** 2)) for b in other] for a in x])


def naive_gaussian_process(x, y, new, length, signal, noise):
    """Mean (m, d), variance (m,) with noise and log p(y) by the textbook's formulas, with inverses and determinants."""
    kernel = naive_covariance(x, x, length, signal) + noise**2 * np.eye(len(x))
    across, inverse = naive_covariance(new, x, length, signal), np.linalg.inv(kernel)
    mean = across @ inverse @ y
    variance = np.array([signal**2 + noise**2 - row @ inverse @ row for row in across])
    _, volume = np.linalg.slogdet(kernel)
    log_p = sum(-0.5 * column @ inverse @ column - 0.5 * volume - 0.5 * len(x) * np.log(2 * np.pi) for column in y.T)
    return mean, variance, log_p


def naive_segment(z, start, way):
    """Distance from z to the line from start to start + way, and the foot of the perpendicular."""
    share = np.clip((z - start) @ way / (way @ way), 0.0, 1.0) if way @ way > 0 else 0.0
    foot = start + share * way
    return np.linalg.norm(z - foot), foot


def naive_steps(tables, control, noise, z0):
    """Paths (n, T, d) and state numbers (n, T) of switching dynamics, point by point, from what ``tables_of`` gives."""
    radius, supports = np.sqrt(float(tables["radius2"])), list(zip(tables["support"], tables["ways"]))
    paths, states = [], []
    for start, known, normals in zip(z0, control, noise):
        path, state = [start], []
        for t in range(len(known)):
            z = path[-1]
            x = np.concatenate([z, known[t]])
            s = _naive_state(x, tables)
            state.append(s)
            if t + 1 == len(known):
                break
            used = int(tables["used"][s])
            near = np.exp(-0.5 * ((x * tables["per_length"][s] - tables["points"][s][:used]) ** 2).sum(axis=1))
            mean = tables["keep"][s] * z + near @ tables["weight"][s][:used]
            known_already = near @ tables["shrink"][s][:used, :used] @ near
            spread = np.sqrt((max(tables["variance"][s] - known_already, 0) + tables["noise"][s]) * tables["scale"][s])
            candidates = [mean + spread * normal for normal in normals[t]] + [mean]
            fits = [new for new in candidates if min(naive_segment(new, *one)[0] for one in supports) <= radius]
            path.append(fits[0] if fits else _naive_followed(z, supports, int(tables["leading"]), radius))
        paths.append(path)
        states.append(state)
    return np.array(paths), np.array(states)


def _naive_state(x, tables):
    latents = []
    for points, per_length, used, weight in zip(
        *(tables[f"border_{name}"] for name in ("points", "per_length", "used", "weight"))
    ):
        near = np.exp(-0.5 * ((x * per_length - points[:used]) ** 2).sum(axis=1))
        latents.append(near @ weight[:used])
    return int(latents[0] > 0) if len(latents) == 1 else int(np.argmax(latents)) if latents else 0


def _naive_followed(z, supports, leading, radius):
    led = min(range(leading), key=lambda j: naive_segment(z, *supports[j])[0])
    new = z + supports[led][1]
    away, foot = min((naive_segment(new, *one) for one in supports), key=lambda pair: pair[0])
    return new if away <= radius else foot + radius / away * (new - foot)


def naive_chain(log_emission, start, move):
    """By all paths: share of each state at each time (T, S), log p, and the likeliest path (T,)."""
    n_times, n_states = log_emission.shape
    weight = {}
    for path in product(range(n_states), repeat=n_times):
        log_p = np.log(start[path[0]]) + sum(np.log(move[a, b]) for a, b in pairwise(path))
        weight[path] = log_p + sum(log_emission[t, s] for t, s in enumerate(path))
    share, total = np.zeros((n_times, n_states)), sum(np.exp(value) for value in weight.values())
    for path, value in weight.items():
        for t, s in enumerate(path):
            share[t, s] += np.exp(value) / total
    return share, np.log(total), np.array(max(weight, key=weight.get))
