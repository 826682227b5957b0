"""The page's decoder in numpy, from the packed columns alone: what the page does, and nothing that it does not."""

from functools import cached_property
from itertools import pairwise

import numpy as np

from opsim.viewer.columns import unpacked_columns

TURN_S, CORNER_M = 0.4, 0.35


class Twin:
    """A packed scene; ``joints_m(worker, time_s)`` is the pose that the page shows, or None."""

    def __init__(self, meta, data):
        self.meta, self.columns = meta, unpacked_columns(meta["columns"], data)
        self.trees = [(tuple(s["names"]), tuple(s["parents"])) for s in meta["skeletons"]]
        self.models = [
            (Scores if m["codec"] == "scores" else Frames)(m, self.trees[m["skeleton"]][1], self.columns)
            for m in meta["models"]
        ]
        self.gone = [n for n, state in enumerate(meta["states"]) if state["name"] in ("off", "absent")]
        sizes = np.cumsum([0, *(3 * (len(parents) - 1) for _, parents in self.trees)])
        self.standing = [self.columns["standing"][a:b].reshape(-1, 3) for a, b in pairwise(sizes)]

    def seg(self, name, row):
        return float(self.columns[f"seg_{name}"][row])

    def end_s(self, worker, row):
        last = row + 1 == self.columns["seg_first"][worker + 1]
        return self.meta["high_s"] if last else self.seg("start_s", row + 1)

    def joints_m(self, worker, time_s):
        first = self.columns["seg_first"]
        starts = self.columns["seg_start_s"][first[worker] : first[worker + 1]]
        row = int(first[worker]) + max(int(np.searchsorted(starts, time_s, side="right")) - 1, 0)
        if self.columns["seg_state"][row] in self.gone:
            return None
        performs = self.columns["seg_performance"][row] >= 0
        return hung(*(self.performing if performs else self.stands)(worker, row, time_s))

    def performing(self, worker, row, time_s):
        start_s, end_s = self.seg("start_s", row), self.end_s(worker, row)
        share = min(max((time_s - start_s) / (end_s - start_s), 0), 1)
        own_s = self.seg("from_s", row) + share * (self.seg("to_s", row) - self.seg("from_s", row))
        number = int(self.columns["seg_performance"][row])
        model = self.models[self.columns["perf_model"][number]]
        directions, bone_m, (x, y, z, yaw) = model.at(int(self.columns["perf_row"][number]), own_s)
        way = int(self.columns["seg_way"][row])
        if way >= 0:
            px, py, heading = self.on_way(way, x, time_s - start_s, end_s - time_s)
            px, py = px - y * np.sin(heading), py + y * np.cos(heading)
        else:
            heading = self.seg("yaw", row)
            c, s = np.cos(heading), np.sin(heading)
            px, py = self.seg("x", row) + c * x - s * y, self.seg("y", row) + s * x + c * y
        return model.parents, directions, bone_m, np.array([px, py, z]), heading + yaw

    def on_way(self, way, own_x, begun_s, left_s):
        rows = slice(self.columns["way_first"][way], self.columns["way_first"][way + 1])
        points = np.column_stack([self.columns["way_x"][rows], self.columns["way_y"][rows]]).astype(float)
        legs = np.diff(points, axis=0)
        long_m = np.hypot(legs[:, 0], legs[:, 1])
        heads = np.arctan2(legs[:, 1], legs[:, 0])
        s = min(max(own_x * long_m.sum() / self.columns["way_own_m"][way], 0), long_m.sum())
        leg = 0
        while leg < len(legs) - 1 and s >= long_m[: leg + 1].sum():
            leg += 1
        into = s - long_m[:leg].sum()
        place = points[leg] + into / long_m[leg] * legs[leg]
        heading = heads[leg]
        if leg + 1 < len(legs):
            reach = min(CORNER_M, long_m[leg] / 2, long_m[leg + 1] / 2)
            if long_m[leg] - into < reach:
                half = 0.5 * (1 - (long_m[leg] - into) / reach)
                heading = heads[leg] + wrapped(heads[leg + 1] - heads[leg]) * half
        if leg > 0:
            reach = min(CORNER_M, long_m[leg] / 2, long_m[leg - 1] / 2)
            if into < reach:
                heading = heads[leg - 1] + wrapped(heads[leg] - heads[leg - 1]) * 0.5 * (1 + into / reach)
        ease = min(TURN_S, (begun_s + left_s) / 3)
        for past, name in ((begun_s, "way_yaw_from"), (left_s, "way_yaw_to")):
            yaw = float(self.columns[name][way])
            if past < ease and not np.isnan(yaw):
                return *place, yaw + wrapped(heading - yaw) * smooth(past / ease)
        return *place, heading

    def stands(self, worker, row, time_s):
        start_s, end_s = self.seg("start_s", row), self.end_s(worker, row)
        ease = min(TURN_S, (end_s - start_s) / 3)
        first, last = self.columns["seg_first"][worker], self.columns["seg_first"][worker + 1] - 1
        now = self.upright(worker, row, (time_s - start_s) / (end_s - start_s))
        if time_s - start_s < ease and row > first and self.columns["seg_state"][row - 1] not in self.gone:
            if self.columns["seg_performance"][row - 1] >= 0:
                before = self.performing(worker, row - 1, start_s)
            else:
                before = self.upright(worker, row - 1, 1.0)
            return mixed(before, now, smooth((time_s - start_s) / ease))
        if end_s - time_s < ease and row < last and self.columns["seg_performance"][row + 1] >= 0:
            return mixed(self.performing(worker, row + 1, end_s), now, smooth((end_s - time_s) / ease))
        return now

    def upright(self, worker, row, share):
        tree = self.columns["stand_skeleton"][worker]
        parents, directions = self.trees[tree][1], self.standing[tree].astype(float)
        n_bones = len(parents) - 1
        bone_m = self.columns["stand_bone_m"].reshape(-1, n_bones)[worker].astype(float)
        hanging = hung(parents, directions, bone_m, np.zeros(3), 0.0)
        root = np.array([self.seg("x", row), self.seg("y", row), -hanging[:, 2].min()])
        if "seg_dx" in self.columns:
            root[:2] += share * np.array([self.seg("dx", row), self.seg("dy", row)])
        return parents, directions, bone_m, root, self.seg("yaw", row)


class Frames:
    def __init__(self, meta, parents, columns):
        own = {role: columns[name] for role, name in meta["columns"].items()}
        self.parents, self.rate_hz, self.d = parents, meta["rate_hz"], meta["sizes"]["directions"]
        self.basis = own["basis"].reshape(self.d + 1, -1).astype(float)
        self.scale, self.first, self.values = own["scale"].astype(float), own["first"].astype(int), own["values"]
        self.bone_m = own["bone_m"].reshape(len(self.first) - 1, -1).astype(float)
        self.duration_s = own["duration_s"].astype(float)
        self.own = own

    def channels(self, row):
        n_frames, width = self.first[row + 1] - self.first[row], self.d + 4
        begin = width * self.first[row]
        differences = self.values[begin : begin + width * n_frames].reshape(width, n_frames).astype(np.int64)
        return np.cumsum(np.cumsum(differences, axis=1), axis=1) * self.scale[:, None]

    def at(self, row, own_s):
        channels = self.channels(row)
        place = min(max(min(own_s, self.duration_s[row]), 0.0) * self.rate_hz, channels.shape[1] - 1)
        cell = max(min(int(place), channels.shape[1] - 2), 0)
        u = place - cell
        a, b, c, d = (channels[:, min(max(cell + k, 0), channels.shape[1] - 1)] for k in (-1, 0, 1, 2))
        now = b + 0.5 * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)))
        directions = (self.basis[0] + now[: self.d] @ self.basis[1:]).reshape(-1, 3)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        if "amend_first" in self.own:
            self.amend(row, min(max(own_s, 0.0), self.duration_s[row]), directions)
        return directions, self.bone_m[row], now[self.d :]

    def amend(self, row, own_s, directions):
        bone, at_s, step = self.own["amend_bone"], self.own["amend_at_s"], float(self.own["amend_step"][0])
        by = self.own["amend_by"].reshape(3, -1).astype(float) * step
        for k in range(int(self.own["amend_first"][row]), int(self.own["amend_first"][row + 1]) - 1):
            if bone[k] == bone[k + 1] and at_s[k] <= own_s < at_s[k + 1]:
                u = (own_s - float(at_s[k])) / (float(at_s[k + 1]) - float(at_s[k]))
                directions[bone[k]] += (1 - u) * by[:, k] + u * by[:, k + 1]
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)


class Scores:
    def __init__(self, meta, parents, columns):
        self.meta, self.parents, self.n = meta, parents, meta["n"]
        self.own = {role: columns[name].astype(float) for role, name in meta["columns"].items()}
        self.T, self.Q, self.B = meta["n_times"], meta["n_knots"], len(parents) - 1

    def sequence(self, what, row):
        k = self.meta["sizes"][what]
        coefficients = self.own[what].reshape(k, self.n)[:, row] * self.own[f"{what}_scale"]
        mean = self.own[f"{what}_mean"]
        return mean + coefficients @ self.own[f"{what}_basis"].reshape(k, mean.size)

    @cached_property
    def frame(self):
        return self.own["frame"].reshape(self.B, 3, 3)

    def whole(self, row):
        """(warp (T,), directions (T, B, 3), bones (B,), path (T, 4)) of a performance."""
        slopes = np.clip(self.sequence("pace", row), self.own["slope_least"], self.own["slope_most"])
        bone_m = np.exp(self.sequence("bones", row)) * self.own["body_scale"][row]
        pairs = self.sequence("posture", row).reshape(self.T, self.B, 2)
        angle = np.linalg.norm(pairs, axis=-1, keepdims=True)
        tangent = pairs[..., :1] * self.frame[:, 1] + pairs[..., 1:] * self.frame[:, 2]
        directions = np.cos(angle) * self.frame[:, 0] + np.sinc(angle / np.pi) * tangent
        channel = self.sequence("root", row).reshape(self.T, 4)
        return warp(slopes, self.T), directions, bone_m, self.ride(directions, bone_m, channel)

    def ride(self, directions, bone_m, channel):
        feet, legs, soft = self.meta["feet"], self.meta["legs"], self.meta["soft_m"]
        leg_m = bone_m[legs].sum() / 2 if legs else bone_m.sum() / 4
        joints = hung(self.parents, directions, bone_m, np.zeros(3), channel[:, 3])
        low = joints[..., 2].min(axis=1)
        way, floor = np.zeros((self.T, 2)), np.zeros(self.T)
        if feet:
            foot = joints[:, feet]
            lowest = foot[..., 2].min(axis=1)
            weight = np.exp((lowest[:, None] - foot[..., 2]) / soft)
            floor = soft * np.log(weight.mean(axis=1)) - lowest
            share = weight / weight.sum(axis=1, keepdims=True)
            both = 0.5 * (share[1:] + share[:-1])
            way[1:] = -np.cumsum((both[..., None] * np.diff(foot[..., :2], axis=0)).sum(axis=1), axis=0)
        level = way + channel[:, :2] * leg_m
        height = np.maximum(floor + channel[:, 2] * leg_m, -low)
        return np.column_stack([level - level[0], height, channel[:, 3]])

    def at(self, row, own_s):
        gamma, directions, bone_m, path = self.whole(row)
        dwell_s = self.own["dwell_s"].reshape(-1, self.n)[:, row]
        moving_s = self.own["duration_s"][row] - dwell_s.sum()
        for clock, pause_s in zip(self.own["dwell_clock"], dwell_s):
            start_s = moving_s * np.interp(clock * (self.T - 1), np.arange(self.T), gamma)
            own_s = own_s - min(max(own_s - start_s, 0.0), pause_s)
        share = min(max(own_s / moving_s, 0.0), 1.0)
        cell = min(max(int(np.searchsorted(gamma, share, side="right")) - 1, 0), self.T - 2)
        u = (share - gamma[cell]) / (gamma[cell + 1] - gamma[cell])
        angle = np.arccos(np.clip((directions[cell] * directions[cell + 1]).sum(-1, keepdims=True), -1, 1))
        small = angle < 1e-6
        sine = np.where(small, 1.0, np.sin(angle))
        p = np.where(small, 1 - u, np.sin((1 - u) * angle) / sine)
        q = np.where(small, u, np.sin(u * angle) / sine)
        now = p * directions[cell] + q * directions[cell + 1]
        return now / np.linalg.norm(now, axis=1, keepdims=True), bone_m, (1 - u) * path[cell] + u * path[cell + 1]


def warp(slopes, n_times):
    rise = np.exp(slopes - slopes.max())
    rise /= rise.sum()
    n = rise.size
    level = np.concatenate([[0], np.cumsum(rise)])
    inner = 2 * rise[:-1] * rise[1:] / (rise[:-1] + rise[1:])
    slope = np.concatenate([rise[:1], inner, rise[-1:]])
    at = np.linspace(0, 1, n_times)
    cell = np.minimum((at * n).astype(int), n - 1)
    u = at * n - cell
    h1, h2, h3 = u * u * (3 - 2 * u), u * (1 - u) ** 2, u * u * (u - 1)
    return (level[cell] + rise[cell] * h1 + slope[cell] * h2 + slope[cell + 1] * h3) / level[-1]


def hung(parents, directions, bone_m, root, heading):
    """Joints (..., J, 3): every bone from its parent, turned by the heading (...)."""
    c, s = np.cos(heading)[..., None], np.sin(heading)[..., None]
    x, y, z = np.moveaxis(directions, -1, 0)
    steps = np.stack([c * x - s * y, s * x + c * y, z], axis=-1) * bone_m[:, None]
    joints = np.zeros((*steps.shape[:-2], len(parents), 3))
    joints[..., parents.index(-1), :] = root
    bones, done = [joint for joint, parent in enumerate(parents) if parent >= 0], {parents.index(-1)}
    while len(done) < len(parents):
        for bone, joint in enumerate(bones):
            if joint not in done and parents[joint] in done:
                joints[..., joint, :] = joints[..., parents[joint], :] + steps[..., bone, :]
                done.add(joint)
    return joints


def mixed(one, other, share):
    if one[0] != other[0]:
        return other
    directions = (1 - share) * one[1] + share * other[1]
    directions = directions / np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-12)
    heading = one[4] + share * wrapped(other[4] - one[4])
    return one[0], directions, *((1 - share) * a + share * b for a, b in zip(one[2:4], other[2:4])), heading


def smooth(share):
    return share * share * (3 - 2 * share)


def wrapped(angle):
    return (angle + np.pi - 1e-4) % (2 * np.pi) - np.pi + 1e-4
