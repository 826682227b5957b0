"""Forward kinematics of a hierarchy of joints with channels, frame by frame. Twin: ``naive_hierarchy`` in tests."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


@compiled(nogil=True, error_model="numpy")
def walk(values, order, parents, first, column, kind, offsets, axes, with_bone, joints):
    """Joints (T, J, 3) of channel values (T, C); angles in degrees.

    order (J,)     : joints, parents before children; parents (J,) with -1
    first (J + 1,) : joint j has the steps first[j] to first[j + 1] - 1 of column (S,) and kind (S,):
                     kind 0, 1, 2 sets x, y, z of its displacement; 3, 4, 5 turns about x, y, z, the last first
    offsets (J, 3) : displacement from the parent where no channel sets it
    axes (J, 3, 3) : frame in which a joint turns; with_bone: the displacement turns with the joint itself (ASF),
                     not with its parent (BVH; axes are then not looked at)
    """
    n_joints = order.size
    turned = np.empty((n_joints, 3, 3))
    local, other = np.empty((3, 3)), np.empty((3, 3))
    step = np.empty(3)
    for t in range(values.shape[0]):
        for k in range(n_joints):
            j = order[k]
            parent = parents[j]
            for a in range(3):
                step[a] = offsets[j, a]
                for b in range(3):
                    local[a, b] = 1.0 if a == b else 0.0
            for s in range(first[j], first[j + 1]):
                value = values[t, column[s]]
                if kind[s] < 3:
                    step[kind[s]] = value
                else:
                    turn_about(local, kind[s] - 3, value)
            if with_bone:
                multiply(axes[j], local, other)
                multiply_transposed(other, axes[j], local)
            if parent >= 0:
                multiply(turned[parent], local, turned[j])
            else:
                turned[j] = local
            carrier = j if with_bone else parent
            for a in range(3):
                moved = step[a]
                if carrier >= 0 and parent >= 0:
                    moved = turned[carrier, a, 0] * step[0] + turned[carrier, a, 1] * step[1]
                    moved += turned[carrier, a, 2] * step[2]
                joints[t, j, a] = moved + (joints[t, parent, a] if parent >= 0 else 0.0)


@compiled(nogil=True, error_model="numpy", inline="always")
def turn_about(matrix, axis, angle_deg):
    """matrix (3, 3) times the turn about axis 0, 1 or 2, written into it."""
    angle = np.radians(angle_deg)
    cosine, sine = np.cos(angle), np.sin(angle)
    b, c = (axis + 1) % 3, (axis + 2) % 3
    for a in range(3):
        left, right = matrix[a, b], matrix[a, c]
        matrix[a, b] = left * cosine + right * sine
        matrix[a, c] = right * cosine - left * sine


@compiled(nogil=True, error_model="numpy", inline="always")
def multiply(left, right, out):
    for a in range(3):
        for b in range(3):
            out[a, b] = left[a, 0] * right[0, b] + left[a, 1] * right[1, b] + left[a, 2] * right[2, b]


@compiled(nogil=True, error_model="numpy", inline="always")
def multiply_transposed(left, right, out):
    for a in range(3):
        for b in range(3):
            out[a, b] = left[a, 0] * right[b, 0] + left[a, 1] * right[b, 1] + left[a, 2] * right[b, 2]
