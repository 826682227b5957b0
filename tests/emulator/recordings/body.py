"""A made body, in the names of rigs and trackers, and written as the files that capture systems write."""

import json
from functools import cache

import numpy as np

from emulator.recordings.take import Take
from emulator.synthetic.tasks import make


@cache
def _reach():
    motions, _ = make("reach", 1, 1)
    return motions.skeleton, motions.motions[0].positions_m(world=True)


def body(n_frames=60, rate_hz=50.0):
    """A reach, canonical joints, in metres, z up, the floor at 0."""
    skeleton, positions = _reach()
    at = np.linspace(0, len(positions) - 1, n_frames).astype(int)
    return Take(skeleton.names, skeleton.parents, positions[at], rate_hz)


def joint(take, name):
    return take.positions_m[:, take.names.index(name)]


def points(take, names):
    """(T, J, 3) of joints by canonical name; a tuple is the middle of several."""
    named = [name if isinstance(name, tuple) else (name,) for name in names]
    return np.stack([np.mean([joint(take, each) for each in way], axis=0) for way in named], axis=1)


def table_text(header, positions, sign=",", first=None):
    """Header lines, then a row a frame; nan is an empty cell."""
    rows = positions.reshape(len(positions), -1)
    if first is not None:
        rows = np.column_stack([first, rows])
    lines = [sign.join("" if np.isnan(value) else f"{value:.6f}" for value in row) for row in rows]
    return "\n".join([*header, *lines]) + "\n"


def trc_text(names, positions, rate_hz=100.0, unit="mm", n_frames=None, n_markers=None):
    n_frames, n_markers = n_frames or len(positions), n_markers or len(names)
    axes = "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(1, len(names) + 1))
    header = [
        "PathFileType\t4\t(X/Y/Z)\ttake.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate_hz:g}\t{rate_hz:g}\t{n_frames}\t{n_markers}\t{unit}\t{rate_hz:g}\t1\t{n_frames}",
        "Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t",
        "\t\t" + axes,
        "",
    ]
    rows = positions.reshape(len(positions), -1)
    lines = [
        "\t".join([str(i + 1), f"{i / rate_hz:.5f}", *("" if np.isnan(v) else f"{v:.5f}" for v in row)])
        for i, row in enumerate(rows)
    ]
    return "\n".join([*header, *lines]) + "\n"


def json_text(document):
    """JSON with nan as null."""

    def plain(value):
        if isinstance(value, np.ndarray):
            return plain(value.tolist())
        if isinstance(value, list):
            return [plain(each) for each in value]
        if isinstance(value, dict):
            return {key: plain(each) for key, each in value.items()}
        return None if isinstance(value, float) and np.isnan(value) else value

    return json.dumps(plain(document))


def write_c3d(path, names, positions, rate_hz=100.0, unit="mm"):
    """Written by ezc3d, which is another's hand; (T, J, 3), nan where a point was not seen."""
    import ezc3d

    file = ezc3d.c3d()
    point = file["parameters"]["POINT"]
    point["RATE"]["value"], point["UNITS"]["value"] = [rate_hz], [unit]
    point["LABELS"]["value"] = list(names)
    held = np.ones((4, len(names), len(positions)))
    held[:3] = positions.transpose(2, 1, 0)
    file["data"]["points"] = held
    file["data"]["meta_points"]["residuals"] = np.where(np.isnan(held[:1]), -1.0, 0.0)
    file.write(str(path))
    return path
