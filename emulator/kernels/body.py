"""Bodies from directions: joints by walking down the bones, and the way of a root that rides on planted feet.

Their twins: Skeleton.positions with clean.turn, RootChannel.inverse_numpy, tests/naive.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.geodesic import FAST


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def stand(directions, length_m, chain, cosine, sine, joints):
    """Joints (J, 3) below a root already placed: directions (3B,), turned about the vertical by cosine and sine.

    chain (B, 3) : bone, parent joint, child joint; a parent comes before its children
    """
    for k in range(chain.shape[0]):
        bone, parent, child = chain[k, 0], chain[k, 1], chain[k, 2]
        x, y, z = directions[3 * bone], directions[3 * bone + 1], directions[3 * bone + 2]
        joints[child, 0] = joints[parent, 0] + length_m[bone] * (cosine * x - sine * y)
        joints[child, 1] = joints[parent, 1] + length_m[bone] * (sine * x + cosine * y)
        joints[child, 2] = joints[parent, 2] + length_m[bone] * z


# NOTE: no fused multiply-add, so that the root is to the bit where root_m puts it.
@compiled(error_model="numpy", nogil=True)
def stand_all(directions, length_m, chain, path, joints):
    """Joints (n, S, J, 3) of directions (n, S, 3B) and lengths (n, B) on paths (n, S, 4).

    path : x, y, z of the root in metres and its heading in radians
    """
    top = chain[0, 1]
    for i in range(directions.shape[0]):
        for s in range(directions.shape[1]):
            at = path[i, s]
            for c in range(3):
                joints[i, s, top, c] = at[c]
            stand(directions[i, s], length_m[i], chain, np.cos(at[3]), np.sin(at[3]), joints[i, s])


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def ride_all(directions, length_m, chain, feet, soft_m, channel, leg_m, root):
    """The way of the root (n, T, 3) from directions (n, T, 3B) and channel (n, T, 4); see ``root.RootChannel``.

    feet (F,) : joints that may carry; leg_m (n,) : what slip and clearance are measured in
    """
    n_feet = feet.size
    joints = np.zeros((chain.shape[0] + 1, 3))
    place, share = np.zeros((2, n_feet, 2)), np.zeros((2, n_feet))
    for i in range(directions.shape[0]):
        way_x, way_y = 0.0, 0.0
        for t in range(directions.shape[1]):
            stand(directions[i, t], length_m[i], chain, np.cos(channel[i, t, 3]), np.sin(channel[i, t, 3]), joints)
            lowest, lowest_foot = np.inf, np.inf
            for j in range(joints.shape[0]):
                lowest = min(lowest, joints[j, 2])
            for f in range(n_feet):
                lowest_foot = min(lowest_foot, joints[feet[f], 2])
            now, last = t % 2, 1 - t % 2
            weight = 0.0
            for f in range(n_feet):
                place[now, f, 0], place[now, f, 1] = joints[feet[f], 0], joints[feet[f], 1]
                share[now, f] = np.exp((lowest_foot - joints[feet[f], 2]) / soft_m)
                weight += share[now, f]
            for f in range(n_feet):
                share[now, f] /= weight
                if t > 0:
                    both = 0.5 * (share[now, f] + share[last, f])
                    way_x -= both * (place[now, f, 0] - place[last, f, 0])
                    way_y -= both * (place[now, f, 1] - place[last, f, 1])
            floor = soft_m * np.log(weight / n_feet) - lowest_foot if n_feet else 0.0
            root[i, t, 0] = way_x + channel[i, t, 0] * leg_m[i]
            root[i, t, 1] = way_y + channel[i, t, 1] * leg_m[i]
            root[i, t, 2] = max(floor + channel[i, t, 2] * leg_m[i], -lowest)
        for c in range(2):
            start = root[i, 0, c]
            for t in range(directions.shape[1]):
                root[i, t, c] -= start
