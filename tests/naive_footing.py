"""The footing of a body, written to be read: see emulator/kernels/footing.py, whose twin this is."""

import numpy as np

from emulator.kernels.feet import AHEAD, FOLDED, MOST_BEND_M, STIFF_KNEE, STRAIGHT
from emulator.motion import stretches, turn


def blurred(values, sigma):
    """Gaussian mean of values (T,) over four standard deviations, the ends held."""
    reach = int(4 * sigma) + 1
    offsets = np.arange(-reach, reach + 1)
    weight = np.exp(-0.5 * (offsets / sigma) ** 2)
    padded = np.pad(values, reach, mode="edge")
    return np.array([weight @ padded[t : t + 2 * reach + 1] for t in range(len(values))]) / weight.sum()


def moves_of(middle, stands, print_m):
    """(T, 3) what brings a foot to where it belongs, eased from stance to stance; zero for one that never stands."""
    moves, last = np.zeros((len(stands), 3)), None
    for start, stop in stretches(stands):
        rows = slice(start, stop)
        place = np.append(np.median((middle - print_m)[rows, :2], axis=0), 0.0)
        moves[rows] = place + print_m[rows] - middle[rows]
        if last is None:
            moves[:start] = moves[start]
        else:
            u = (np.arange(last + 1, start) - last)[:, None] / (start - last)
            moves[last + 1 : start] = moves[last] + u**3 * (10 - 15 * u + 6 * u**2) * (moves[start] - moves[last])
        last = stop - 1
    if last is not None:
        moves[last + 1 :] = moves[last]
    return moves


def raised(lacking, sigma):
    """(T,) what is added to something that lacks these heights (T,): the most that lacks nearby, blurred."""
    reach = int(4 * sigma) + 1
    lacking = np.maximum(lacking, 0.0)
    nearby = np.array([lacking[max(t - reach, 0) : t + reach + 1].max() for t in range(len(lacking))])
    return blurred(nearby, sigma)


def stood(skeleton, legs, directions, length_m, path, stands, prints_m, time_s, floor_m, foot_floor_m):
    """One body: its path (T, 4) moved until the feet stand, and what the legs bend (2, T, 3)."""
    joints = skeleton.positions(turn(directions, path[:, 3:]), length_m, path[:, :3])
    step = time_s[-1] / (len(time_s) - 1)
    wide, narrow = 0.08 / step, 0.06 / step
    moves, weight = [], []
    for f, foot in enumerate(legs.feet):
        move = moves_of(joints[:, foot].mean(axis=1), stands[f], turn(prints_m[f], path[:, 3]))
        sunk = (foot_floor_m[f] - joints[:, foot, 2]).max(axis=1) - move[:, 2]
        move[:, 2] += raised(sunk, narrow) * stands[f].any()
        moves.append(move)
        weight.append(blurred(stands[f] + 1e-3, wide) * stands[f].any())
    total = sum(weight)
    mean = sum(w[:, None] * m for w, m in zip(weight, moves)) / np.maximum(total, 1e-300)[:, None]
    shift = np.stack([blurred(column, narrow) for column in mean.T], axis=1)
    shift[:, 2] += raised(floor_m - joints[..., 2].min(axis=1) - shift[:, 2], narrow)
    bends = []
    for f in range(2):
        bend = moves[f] - shift
        far = np.linalg.norm(bend, axis=1, keepdims=True) / MOST_BEND_M
        bends.append(turn(bend * np.tanh(far) / np.maximum(far, 1e-300) * stands[f].any(), -path[:, 3]))
    return np.concatenate([path[:, :3] + shift, path[:, 3:]], axis=1), np.array(bends)


def bent(thigh, shank, move):
    """Thigh and shank (3,) of a leg whose ankle follows ``move`` (3,): lengths stay, the knee keeps to its side."""
    long = np.linalg.norm(thigh), np.linalg.norm(shank)
    full, drawn = sum(long), np.linalg.norm(thigh + shank)
    u = np.clip((drawn / full - FOLDED[0]) / (FOLDED[1] - FOLDED[0]), 0, 1)
    leg = thigh + shank + u * u * (3 - 2 * u) * move
    slack = max(full - drawn, 0) / full
    reach = drawn + (np.linalg.norm(leg) - drawn) * slack / (slack + STIFF_KNEE)
    reach = min(max(reach, abs(long[0] - long[1]) + 1e-4), max(drawn, STRAIGHT * full))
    along = leg / np.linalg.norm(leg)
    side = thigh + AHEAD * full * np.array([1.0, 0, 0])
    side = side - (side @ along) * along
    fore = (long[0] ** 2 - long[1] ** 2 + reach**2) / (2 * reach)
    knee = fore * along + np.sqrt(max(long[0] ** 2 - fore**2, 0)) * side / np.linalg.norm(side)
    return knee, reach * along - knee
