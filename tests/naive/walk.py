"""Twins of the kernels that walking is drawn with: all frames at once in numpy, to be read. See tests/naive.py."""

import numpy as np

from emulator.kernels.bodies import AHEAD, REACH, RISE
from emulator.kernels.bodies import SOFT_M as SOFT_HIPS_M
from emulator.kernels.planting import BEHIND, EASY, LOWEST, SOFT_M, SPARE
from emulator.motion import stretches
from tests.naive import naive_steps


def rise_frame(foot, start, stop, held):
    """The frame of a stance [start, stop) from which the foot turns about its toe: (T, 3) unit vectors ankle to toe.

    stop if it never does. held : the stance goes on to the end, where nobody pushes off.
    """
    if held or stop - start < 4:
        return stop
    down = -foot[start:stop, 2]
    middle = down[(stop - start) // 4 : max((stop - start) // 2, (stop - start) // 4 + 1)]
    flat = np.flatnonzero(down <= np.median(middle) + RISE)
    last = int(flat[-1]) if len(flat) else len(down) // 2
    return start + max(last, (stop - start) // 4)


def naive_shares(contact):
    """(T, 2) how much each foot carries: 0 in the air, in double support from the old one to the new one evenly.

    Where both bear from the start or to the end each carries half; with no foot on the floor the last shares go on.
    """
    contact = np.asarray(contact, bool)
    share = contact.astype(float)
    for start, stop in stretches(np.all(contact, axis=1)):
        before = share[start - 1] if start else np.full(2, 0.5)
        after = share[stop] if stop < len(share) else np.full(2, 0.5)
        ease = ((np.arange(stop - start) + 1) / (stop - start + 1))[:, None]
        share[start:stop] = (1 - ease) * before + ease * after
    for start, stop in stretches(~np.any(contact, axis=1)):
        share[start:stop] = share[start - 1] if start else np.full(2, 0.5)
    total = share.sum(axis=1, keepdims=True)
    return np.asarray(share / np.where(total > 0, total, 1.0))


def naive_way(hanging_m, contact, skeleton):
    """The level way (T, 2) of the root of joints (T, J, 3), root at 0, if bearing feet stay; from x = y = 0.

    In double support both feet have their say by how much they carry.
    """
    share, way = naive_shares(contact), np.zeros((len(hanging_m), 2))
    for number, side in enumerate(("left", "right")):
        ankle, toe = (hanging_m[:, skeleton.index(f"{side}_{joint}")] for joint in ("ankle", "toe"))
        step = np.diff(ankle[:, :2], axis=0)
        foot = toe - ankle
        foot = foot / np.linalg.norm(foot, axis=-1, keepdims=True)
        for start, stop in stretches(contact[:, number]):
            rise = rise_frame(foot, start, stop, stop == len(contact))
            step[rise : stop - 1] = np.diff(toe[rise:stop, :2], axis=0)
        carried = 0.5 * (share[1:, number] + share[:-1, number])
        way[1:] -= np.cumsum(carried[:, None] * step, axis=0)
    return way


def naive_targets(own, time_s, raw_m, foot, hip_m):
    """(T, 3) ankles and feet, for postures with ankles raw_m, feet along ``foot`` and hips hip_m, each (T, 3)."""
    at, bears = own._at(time_s), own.bears(time_s)[:, None]
    pitch = np.where(time_s <= own.rise_s[at], np.maximum(foot[:, 2], own.flat), foot[:, 2])
    planted, standing = planted_foot(pitch, own.ankle_m[at], own.way_rad[at], own.flat, own.foot_m, hip_m, own.leg_m)
    missing = _missing(own, time_s, at)
    flown = raw_m + missing[:, :3]
    near = within_reach(flown, hip_m, own.leg_m)
    over = _flight(own, time_s, at)
    flown = flown + (_eased(over / 0.25) * _eased((1 - over) / 0.5))[:, None] * (near - flown)
    flying = pointing(_way(foot) + missing[:, 3], foot[:, 2] + missing[:, 4])
    soft_m = SOFT_M * (1 + 6 * np.clip(4 * over * (1 - over), 0.0, 1.0))
    flying = raised(flying, flown, own.toe_least_m, own.foot_m, soft_m)
    return np.where(bears, planted, flown), np.where(bears, standing, flying)


def _flight(own, time_s, at):
    """(T,) share of the flight after stance ``at`` that is over."""
    following = np.minimum(at + 1, len(own.on_s) - 1)
    return np.asarray((time_s - own.off_s[at]) / np.maximum(own.on_s[following] - own.off_s[at], 1e-6))


def _missing(own, time_s, at):
    """(T, 5) in flight: a cubic between what is missing at both ends, with its rates; held before and after all."""
    following = np.minimum(at + 1, len(own.on_s) - 1)
    fly_s = np.maximum(own.on_s[following] - own.off_s[at], 1e-6)
    u = np.clip((time_s - own.off_s[at]) / fly_s, 0.0, 1.0)[:, None]
    rest = (following == at)[:, None]
    start, end = own.missing[at, 1], np.where(rest, own.missing[at, 1], own.missing[following, 0])
    leave = np.where(rest, 0.0, own.missing_per_s[at, 1] * fly_s[:, None])
    arrive = np.where(rest, 0.0, own.missing_per_s[following, 0] * fly_s[:, None])
    return np.asarray(
        start * (1 + 2 * u) * (1 - u) ** 2
        + end * u**2 * (3 - 2 * u)
        + leave * u * (1 - u) ** 2
        - arrive * u**2 * (1 - u)
    )


def planted_foot(
    pitch,
    ankle_m,
    way_rad,
    flat,
    foot_m,
    hip_m,
    leg_m,
):
    """(T, 3) ankle and direction of a bearing foot: pitch (T,) is the z of the posture's foot."""
    toe = ankle_m + foot_m * pointing(way_rad, np.full_like(pitch, flat))
    pitch = pitch.copy()
    ankle = toe - foot_m * pointing(way_rad, np.minimum(pitch, flat))
    behind = _eased(np.sum((hip_m - ankle)[:, :2] * pointing(way_rad, 0 * pitch)[:, :2], axis=-1) / (BEHIND * leg_m))
    short = np.flatnonzero((behind > 0) & (np.linalg.norm(ankle - hip_m, axis=-1) > EASY * leg_m))
    if len(short):
        now = np.minimum(pitch[short], flat)
        up = _heel_up(now, toe[short], way_rad[short], foot_m, hip_m[short], leg_m)
        pitch[short] += behind[short] * (up - pitch[short])
        pitch[short] = np.minimum(pitch[short], now)
        ankle[short] = toe[short] - foot_m * pointing(way_rad[short], pitch[short])
    return ankle, pointing(way_rad, pitch)


def _heel_up(pitch, toe, way_rad, foot_m, hip_m, leg_m: float):
    """(T,) lower pitches at which the leg is as long as ``drawn_in`` lets it be (law of cosines); LOWEST if none."""
    gap = toe - hip_m
    wanted = drawn_in(np.linalg.norm(gap - foot_m * pointing(way_rad, pitch), axis=-1), leg_m)
    ahead = gap[:, 0] * np.cos(way_rad) + gap[:, 1] * np.sin(way_rad)
    share = (np.sum(gap * gap, axis=-1) + foot_m**2 - wanted**2) / (2 * foot_m * np.hypot(ahead, gap[:, 2]))
    angle = np.arctan2(gap[:, 2], ahead) + np.arccos(np.clip(share, -1.0, 1.0))
    return np.minimum(np.sin(np.maximum(angle, np.arcsin(LOWEST))), pitch)


def drawn_in(apart_m, leg_m):
    """How far hip and ankle may be apart, where the posture says ``apart_m``: the same up to EASY of the leg."""
    beyond = np.maximum(apart_m / leg_m - EASY, 0.0)
    return np.asarray(np.where(beyond > 0, leg_m * (EASY - SPARE * np.expm1(-beyond / SPARE)), apart_m))


def within_reach(ankle_m, hip_m, leg_m):
    """Ankles (T, 3), those too far from the hip drawn in along the line to it."""
    apart = ankle_m - hip_m
    distance = np.linalg.norm(apart, axis=-1)
    return np.asarray(hip_m + apart * (drawn_in(distance, leg_m) / np.maximum(distance, 1e-9))[:, None])


def pointing(way_rad, height):
    """Unit vectors (T, 3) to a side seen from above, of this z."""
    height = np.clip(height, -0.999, 0.999)
    level = np.sqrt(1.0 - height**2)
    return np.stack([level * np.cos(way_rad), level * np.sin(way_rad), height], axis=-1)


def raised(foot, ankle_m, toe_least_m, foot_m, soft_m):
    """Unit vectors foot (T, 3), turned up as far as the toe must not be below ``toe_least_m``, within soft_m (T,)."""
    soft = soft_m / foot_m
    least = np.minimum((toe_least_m - ankle_m[:, 2]) / foot_m, 0.9)
    return pointing(_way(foot), foot[:, 2] + soft * np.logaddexp(0.0, (least - foot[:, 2]) / soft))


def _eased(u):
    """0 to 1 over u from 0 to 1, softly."""
    u = np.clip(u, 0.0, 1.0)
    return np.asarray(u * u * (3 - 2 * u))


def _way(foot):
    return np.arctan2(foot[..., 1], foot[..., 0])


def naive_wanting(joints_m, ankles_m, legs, bone_m):
    """(T,) how much the hips must come down so that no leg of joints (T, J, 3) stretches to its ankle (T, 2, 3).

    Below 0 there is room to spare.
    """
    room = []
    for (hip, knee, ankle, _), target in zip(legs.joints, np.moveaxis(ankles_m, 1, 0)):
        apart = target - joints_m[:, hip]
        full = REACH * (bone_m[knee] + bone_m[ankle])
        level = np.minimum(np.linalg.norm(apart[:, :2], axis=-1), 0.98 * full)
        room.append(-(apart[:, 2] + np.sqrt(full**2 - level**2)))
    return np.asarray(np.max(room, axis=0))


def naive_stand_on(joints_m, ankles_m, feet, legs, bone_m):
    """Joints (T, J, 3) with the ankles at ankles_m (T, 2, 3), feet along unit vectors (T, 2, 3), knees on their side.

    bone_m : length of the bone that ends in a joint. An ankle out of reach is approached to ``REACH`` of the leg.
    """
    out = joints_m.copy()
    lowered = SOFT_HIPS_M * np.logaddexp(0.0, naive_wanting(joints_m, ankles_m, legs, bone_m) / SOFT_HIPS_M)
    out[..., 2] -= lowered[:, None]
    for number, ((hip, knee, ankle, toe), hanging) in enumerate(zip(legs.joints, legs.below)):
        target = ankles_m[:, number]
        side = _bent_to(joints_m[:, hip], joints_m[:, knee], joints_m[:, ankle], feet[:, number])
        place = {knee: 0, ankle: 1}
        middle, end = _two_bones(out[:, hip], target, bone_m[knee], bone_m[ankle], side)
        before = {joint: joints_m[:, joint] - joints_m[:, parent] for joint, parent in hanging}
        out[:, [knee, ankle]] = np.stack([middle, end], axis=1)[:, [place[knee], place[ankle]]]
        turned = feet[:, number] * np.linalg.norm(before[toe], axis=-1, keepdims=True) if toe in before else None
        for joint, parent in hanging:
            out[:, joint] = out[:, parent] + (turned if joint == toe and parent == ankle else before[joint])
    return out


def _bent_to(hip, knee, ankle, foot):
    """(T, 3) the side to which a knee is bent: off the line from hip to ankle, and a little where the foot points.

    The latter decides where the leg is nearly straight, so that a knee never turns round.
    """
    along = _unit(ankle - hip)
    off = knee - hip
    off = off - np.sum(off * along, axis=-1, keepdims=True) * along
    level = foot * np.array([1.0, 1.0, 0.0])
    return off / np.linalg.norm(knee - hip, axis=-1, keepdims=True) + AHEAD * _unit(level)


def _two_bones(start, target, upper, lower, side):
    """Middle and end (T, 3) of a limb; its middle lies on the ``side`` (T, 3) of the line where it was."""
    apart = target - start
    distance = np.linalg.norm(apart, axis=-1, keepdims=True)
    along = apart / np.maximum(distance, 1e-9)
    reach = np.clip(distance, abs(upper - lower) + 0.02, REACH * (upper + lower))
    fore = (upper**2 - lower**2 + reach**2) / (2 * reach)
    out = side - np.sum(side * along, axis=-1, keepdims=True) * along
    out = out / np.maximum(np.linalg.norm(out, axis=-1, keepdims=True), 1e-9)
    height = np.sqrt(np.maximum(upper**2 - fore**2, 0.0))
    middle = start + fore * along + height * out
    end = start + reach * along
    # exactly as long as they are, whatever rounding did
    middle = start + upper * _unit(middle - start)
    return middle, middle + lower * _unit(end - middle)


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)


def naive_beat(tables, control, noise, start, bears, earliest, fewest):
    """The whole path (T, d), states (T,), and the frame in which the foot of bears (S,) comes down; -1 for none."""
    z, state = naive_steps(tables, control[None], noise[None], start[None])
    down = bears[state[0]]
    ends = [t for t in range(max(earliest, 1), len(down)) if down[t] and not down[max(t - fewest, 0) : t].any()]
    return z[0], state[0], ends[0] if ends else -1


def naive_gaps(time_s, runs, raw_m, foot, hip_m, place_m, foot_m, leg_m, flat):
    """Of each stance: when the heel rises, where the foot points, what is missing at both ends and its rates."""
    raw = np.column_stack([raw_m, np.unwrap(_way(foot)), foot[:, 2]])
    found = []
    for (start, stop), place in zip(runs, place_m):
        rows, n = slice(start, stop), stop - start
        way = raw[slice(start + n // 5, max(start + 3 * n // 5, start + 1)), 3].mean()
        flat_at = np.flatnonzero(foot[rows, 2] >= flat)
        held = stop == len(time_s) or not len(flat_at)
        rise = stop if held else start + flat_at[-1]
        pitch = np.where(np.arange(start, stop) <= rise, np.maximum(foot[rows, 2], flat), foot[rows, 2])
        ankle, standing = planted_foot(pitch, np.tile(place, (n, 1)), np.full(n, way), flat, foot_m, hip_m[rows], leg_m)
        gap = np.column_stack([ankle, np.full(n, way), standing[:, 2]]) - raw[rows]
        rate = np.gradient(gap, time_s[rows], axis=0) if n > 1 else np.zeros_like(gap)
        found.append((np.inf if held else time_s[rise], way, gap[[0, -1]], rate[[0, -1]]))
    return [np.array(column) for column in zip(*found)]


def naive_hung(skeleton, directions, yaw, length_m, root_m):
    """Joints (T, J, 3) of directions (T, B, 3) of any length."""
    unit = directions / np.linalg.norm(directions, axis=-1, keepdims=True)
    turned = np.stack(
        [
            np.cos(yaw)[:, None] * unit[..., 0] - np.sin(yaw)[:, None] * unit[..., 1],
            np.sin(yaw)[:, None] * unit[..., 0] + np.cos(yaw)[:, None] * unit[..., 1],
            unit[..., 2],
        ],
        axis=-1,
    )
    return skeleton.positions(turned, length_m, root_m)
