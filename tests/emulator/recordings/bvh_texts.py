"""Small BVH files for the tests."""

import numpy as np

ARM = """HIERARCHY
ROOT Hips
{
\tOFFSET 0 0 0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT Elbow
\t{
\t\tOFFSET 10 0 0
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tEnd Site
\t\t{
\t\t\tOFFSET 5 0 0
\t\t}
\t}
}
MOTION
Frames: 2
Frame Time: 0.01
1 2 3 0 0 0 0 0 0
0 0 0 90 0 0 0 0 90
"""
"""An arm of two bones, 10 and 5 long, along x: straight at (1, 2, 3); then raised by 90 degrees, bent at the elbow."""


def written(folder, text, name="a.bvh"):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def random_file(rng, n_frames=3, n_joints=12):
    """A BVH file of any channels in any order: (text, parents, offsets, channels, values)."""
    kinds = np.array([f"{axis}{what}" for what in ("position", "rotation") for axis in "XYZ"])
    parents = [-1, *(int(rng.integers(0, j)) for j in range(1, n_joints))]
    offsets = rng.normal(size=(n_joints, 3)).round(4) * 10
    channels = [tuple(rng.permutation(kinds)[: rng.integers(1 if j == 0 else 0, 7)]) for j in range(n_joints)]
    order, lines = [], []

    def write(joint, depth):
        order.append(joint)
        lines.append(f"{'ROOT' if depth == 0 else 'JOINT'} j{joint}" + " {")
        lines.append("OFFSET " + " ".join(map(repr, offsets[joint].tolist())))
        if channels[joint] or joint % 2:
            lines.append(" ".join(["CHANNELS", str(len(channels[joint])), *channels[joint]]))
        for child in range(n_joints):
            if parents[child] == joint:
                write(child, depth + 1)
        lines.append("}")

    write(0, 0)
    columns = sum(map(len, channels))
    values = (rng.normal(size=(n_frames, columns)) * 90).round(5)
    lines += ["MOTION", f"Frames: {n_frames}", "Frame Time: 0.0333333"]
    lines += [" ".join(map(repr, row)) for row in values.tolist()]
    return (
        "HIERARCHY\n" + "\n".join(lines) + "\n",
        tuple(order.index(parents[j]) if parents[j] >= 0 else -1 for j in order),
        offsets[order],
        [channels[j] for j in order],
        values,
    )
