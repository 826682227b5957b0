"""The page's decoder in numpy, from the packed columns alone: what the page does, and nothing that it does not."""

from itertools import pairwise

import numpy as np

from opsim.viewer.skeletons import unpacked_columns

TURN_S, CORNER_M = 0.4, 0.35


class Twin:
    """A packed scene; ``joints_m(worker, time_s)`` is the pose that the page shows, or None."""

    def __init__(self, meta, data):
        self.meta, self.columns = meta, unpacked_columns(meta["columns"], data)
        self.trees = [(tuple(s["names"]), tuple(s["parents"])) for s in meta["skeletons"]]
        self.models = [Frames(m, self.trees[m["skeleton"]][1], self.columns) for m in meta["models"]]
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
        self.scale, self.first, self.values = (
            own["scale"].astype(float),
            own["first"].astype(int),
            unfolded(own["values"]),
        )
        self.bone_m = own["bone_m"].reshape(len(self.first) - 1, -1).astype(float)
        self.duration_s = own["duration_s"].astype(float)
        self.own = own

    def channels(self, row):
        n_frames, width = self.first[row + 1] - self.first[row], self.d + 4
        begin = width * self.first[row]
        differences = self.values[begin : begin + width * n_frames].reshape(width, n_frames)
        return np.cumsum(np.cumsum(differences, axis=1), axis=1) * self.scale[:, None]

    def at(self, row, own_s):
        channels = self.channels(row)
        place = min(max(min(own_s, self.duration_s[row]), 0.0) * self.rate_hz, channels.shape[1] - 1)
        cell = max(min(int(place), channels.shape[1] - 2), 0)
        u = place - cell
        b, c = channels[:, cell], channels[:, min(cell + 1, channels.shape[1] - 1)]
        a = channels[:, cell - 1] if cell > 0 else 2 * b - c
        d = channels[:, cell + 2] if cell + 2 < channels.shape[1] else 2 * c - b
        now = ((1 - u) ** 3 * a + (4 - 6 * u**2 + 3 * u**3) * b + (1 + 3 * (u + u**2 - u**3)) * c + u**3 * d) / 6
        directions = (self.basis[0] + now[: self.d] @ self.basis[1:]).reshape(-1, 3)
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        if "amend_first" in self.own:
            self.amend(row, min(max(own_s, 0.0), self.duration_s[row]), directions)
        return directions, self.bone_m[row], now[self.d :]

    def amend(self, row, own_s, directions):
        bone, at_s, step = self.own["amend_bone"], self.own["amend_at_s"], float(self.own["amend_step"][0])
        by = unfolded(self.own["amend_by"]).reshape(3, -1) * step
        for k in range(int(self.own["amend_first"][row]), int(self.own["amend_first"][row + 1]) - 1):
            if bone[k] == bone[k + 1] and at_s[k] <= own_s < at_s[k + 1]:
                u = (own_s - float(at_s[k])) / (float(at_s[k + 1]) - float(at_s[k]))
                directions[bone[k]] += (1 - u) * by[:, k] + u * by[:, k + 1]
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)


def unfolded(values):
    values = values.astype(np.int64)
    return (values >> 1) ^ -(values & 1)


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
