"""The footing of a body, written to be read: see emulator/kernels/feet.py and legs.py, whose twin this is."""

import numpy as np
from scipy.spatial.transform import Rotation

from emulator.kernels.feet import BALANCING, CARRY_S, FEET_S, ROOT_S, SETTLING
from emulator.kernels.legs import AHEAD, FOLDED, MOST_BEND_M, SIDEWAYS, STIFF_KNEE, STRAIGHT
from emulator.motion import stretches, turn


def blurred(values, sigma):
    """Gaussian mean of values (T,) over four standard deviations, the ends held."""
    reach = int(4 * sigma) + 1
    offsets = np.arange(-reach, reach + 1)
    weight = np.exp(-0.5 * (offsets / sigma) ** 2)
    padded = np.pad(values, reach, mode="edge")
    return np.array([weight @ padded[t : t + 2 * reach + 1] for t in range(len(values))]) / weight.sum()


def moves_of(middle, toward, stands, print_m, yaw):
    """(T, 6) what brings a foot's middle and direction to where they belong, eased from stance to stance, else zero."""
    moves, last = np.zeros((len(stands), 6)), None
    level = turn(print_m[:, :3], yaw)
    for start, stop in stretches(stands):
        rows = slice(start, stop)
        place = np.append(np.median((middle - level)[rows, :2], axis=0), 0.0)
        moves[rows, :3] = place + level[rows] - middle[rows]
        if print_m.shape[1] == 6:
            foot, own = print_m[rows, 3:], toward[rows]
            across = np.sum(foot[:, 0] * own[:, 1] - foot[:, 1] * own[:, 0])
            moves[rows, 3:] = turn(foot, np.arctan2(across, np.sum(foot[:, :2] * own[:, :2]))) - own
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


def off_feet(centre, places, weight):
    """(2,) from the nearest place between two feet, places (2, 2), to a centre of mass, seen from above.

    The way between the feet is what lies between their mean and each, the less of it the less the lighter one carries.
    """
    share = weight / max(weight.sum(), 1e-300)
    mean = share @ places
    less = min(2 * share.min(), 1.0) if weight.any() else 0.0
    ends = mean + less * (places - mean)
    way = ends[1] - ends[0]
    along = np.clip((centre - ends[0]) @ way / max(way @ way, 1e-300), 0, 1)
    return centre - ends[0] - along * way


def held_up(centres, places, weight, stray_m):
    """(T, 2) how bodies move whose centres of mass (T, 2) are farther off their feet than ``stray_m`` (T,)."""
    off = np.array([off_feet(c, places[:, t], weight[:, t]) for t, c in enumerate(centres)])
    far = np.linalg.norm(off, axis=1)
    return -off * (np.maximum(far - stray_m, 0) / np.maximum(far, 1e-12))[:, None]


def stood(skeleton, legs, directions, length_m, path, time_s, stance, number):
    """One body: its path (T, 4) moved until the feet stand, and what the legs bend and the feet turn (2, T, 6)."""
    stands, prints_m = stance.stands[number], stance.prints_m[number]
    floor_m, foot_floor_m = stance.floor_m[number], stance.foot_floor_m[number]
    joints = skeleton.positions(turn(directions, path[:, 3:]), length_m, path[:, :3])
    step, yaw = time_s[-1] / (len(time_s) - 1), path[:, 3]
    wide, narrow, slow = CARRY_S / step, FEET_S / step, ROOT_S / step
    moves, weight, turns, feet = [], [], [], []
    for f, (ankle, toe) in enumerate(legs.feet):
        foot_m = np.linalg.norm(joints[:, toe] - joints[:, ankle], axis=1)[:, None]
        toward = (joints[:, toe] - joints[:, ankle]) / foot_m
        move = moves_of(joints[:, [ankle, toe]].mean(axis=1), toward, stands[f], prints_m[f], yaw)
        foot = toward + move[:, 3:]
        foot /= np.linalg.norm(foot, axis=1, keepdims=True)
        move = move[:, :3] - foot_m * (foot - toward) / 2
        ends = joints[:, ankle, 2] + move[:, 2], joints[:, ankle, 2] + move[:, 2] + foot_m[:, 0] * foot[:, 2]
        move[:, 2] += raised(np.max(foot_floor_m[f] - np.transpose(ends), axis=1), narrow) * stands[f].any()
        moves.append(move)
        turns.append(foot - toward)
        feet.append(foot_m * foot)
        weight.append(blurred(stands[f] + 1e-3, wide) * stands[f].any())
    shift = np.zeros((len(path), 3))
    for settling in range(1 + SETTLING):
        left = [move - shift for move in moves]
        if settling:
            left = [move - followed(directions, length_m, bones, move, yaw) for bones, move in zip(legs.bones, left)]
        total = np.maximum(sum(weight), 1e-300)[:, None]
        mean = sum(w[:, None] * move for w, move in zip(weight, left)) / total
        shift = shift + np.stack([blurred(column, slow) for column in mean.T], axis=1)
    ankles = joints[:, legs.feet[:, 0]].swapaxes(0, 1) + np.array(moves)
    places = (ankles + np.array(feet) / 2)[..., :2]
    for _ in range(BALANCING):
        over = held_up((legs.mass @ joints + shift)[:, :2], places, np.array(weight), stance.stray_m[number])
        shift[:, :2] += np.stack([blurred(column, slow) for column in over.T], axis=1)
    lacking = [floor_m - joints[..., 2].min(axis=1) - shift[:, 2]]
    for f, (ankle, _) in enumerate(legs.feet):
        there_m = (
            joints[:, ankle, 2]
            + shift[:, 2]
            + followed(directions, length_m, legs.bones[f], moves[f] - shift, yaw)[:, 2]
        )
        lacking += [foot_floor_m[f, 0] - there_m, foot_floor_m[f, 1] - there_m - feet[f][:, 2]]
    shift[:, 2] += raised(np.max(lacking, axis=0), narrow)
    bends = []
    for f in range(2):
        bend = np.concatenate([turn(softly(moves[f] - shift), -yaw), turn(turns[f], -yaw)], axis=1)
        bends.append(bend * stands[f].any())
    return np.concatenate([path[:, :3] + shift, path[:, 3:]], axis=1), np.array(bends)


def followed(directions, length_m, bones, move, yaw):
    """By how much (T, 3) an ankle goes that is to go by ``move`` (T, 3)."""
    thigh, shank = (length_m[bone] * directions[:, bone] for bone in bones)
    after = [leg_after(*leg) for leg in zip(thigh, shank, turn(softly(move), -yaw))]
    return turn(np.array(after) - thigh - shank, yaw)


def softly(move):
    """Moves (T, 3) drawn in to MOST_BEND_M."""
    far = np.linalg.norm(move, axis=1, keepdims=True) / MOST_BEND_M
    return move * (1 + far**4) ** -0.25


def leg_after(thigh, shank, move):
    """Hip to ankle (3,) of a leg whose ankle is to go by ``move`` (3,)."""
    long = np.linalg.norm(thigh), np.linalg.norm(shank)
    full, drawn = sum(long), np.linalg.norm(thigh + shank)
    leg = thigh + shank + unfolded(drawn / full) * move
    slack = max(full - drawn, 0) / full
    reach = drawn + (np.linalg.norm(leg) - drawn) * slack / (slack + STIFF_KNEE)
    return min(max(reach, abs(long[0] - long[1]) + 1e-4), max(drawn, STRAIGHT * full)) * leg / np.linalg.norm(leg)


def unfolded(share):
    """From 0 to 1 where a leg is this share of its length, through FOLDED."""
    u = np.clip((share - FOLDED[0]) / (FOLDED[1] - FOLDED[0]), 0, 1)
    return u * u * (3 - 2 * u)


def bent(thigh, shank, move):
    """Thigh and shank (3,) of a leg whose ankle follows ``move`` (3,): lengths stay, the knee keeps to its side."""
    leg, long = leg_after(thigh, shank, move), (np.linalg.norm(thigh), np.linalg.norm(shank))
    reach = np.linalg.norm(leg)
    along = leg / reach
    side = thigh - (thigh @ along) * along
    ahead = np.array([1.0, 0, 0]) - along[0] * along
    level, least = ahead @ ahead, AHEAD * sum(long)
    now = side @ ahead / np.sqrt(level)
    want = least + least * np.logaddexp(0, now / least - 1)
    side = side + unfolded(reach / sum(long)) * (want - now) * np.sqrt(level) / (level + SIDEWAYS) * ahead
    fore = (long[0] ** 2 - long[1] ** 2 + reach**2) / (2 * reach)
    knee = fore * along + np.sqrt(max(long[0] ** 2 - fore**2, 0)) * side / np.linalg.norm(side)
    return knee, leg - knee


def turned(bones, by):
    """The bones (K, 3) of a foot after the least rotation that changes the unit vector of their sum ``by`` (3,)."""
    was = bones.sum(axis=0) / np.linalg.norm(bones.sum(axis=0))
    foot = (was + by) / np.linalg.norm(was + by)
    return Rotation.align_vectors([foot, np.cross(was, foot)], [was, np.cross(was, foot)])[0].apply(bones)
