"""The replay as one HTML file: the page, what is known in JSON, and the columns of each variant as base64 of gzip.

A scene as the page reads it: a description, and all its numbers in one run of bytes.
"""

from __future__ import annotations

import base64
import gzip
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from opsim import __version__
from opsim.files import whole_file
from opsim.report.page import policy
from opsim.report.plot.plotly import OTHER, STATE_COLOURS, WORDS
from opsim.threads import one_blas_thread
from opsim.viewer.frame_codec import pack_frames
from opsim.viewer.scene import Scene
from opsim.viewer.skeletons import Columns, Tree, tree_of

FORMAT = 1
SPEEDS = (0.5, 1, 2, 5, 10, 20, 50, 100, 200)
HERE = Path(__file__).parent
AT_ONCE = 3 * 2**18
"""Bytes that become base64 at a time: a multiple of three, so that the pieces join without padding."""
LEVEL = 6
"""Of gzip: 9 takes three times as long and saves 1 %."""
_HERE = "<!-- the columns stand here -->"


def write_replay(
    parts: Sequence[tuple[dict[str, Any], bytes]], path: str | Path, title: str, notes: Sequence[tuple[str, str]] = ()
) -> int:
    """Write the page and return how many bytes it has; the same parts give the same bytes.

    parts : of each variant what is known of it, with the table of its columns, and the raw bytes of these
    notes : (topic, words): what is shown and what is not known
    Raises ValueError for no variant at all.
    """
    if not parts:
        raise ValueError("a replay needs a variant at least; found none")
    variants = [variant for variant, _ in parts]
    before, after = _page(variants, title, _notes(variants, notes)).split(_HERE)
    written = 0
    with whole_file(Path(path)) as temporary, open(temporary, "wb") as out:
        written += out.write(before.encode())
        for number, (_, columns) in enumerate(parts):
            written += sum(out.write(piece) for piece in _block(number, columns))
        written += out.write(after.encode())
    return written


@lru_cache(maxsize=1)
def page_script() -> str:
    """The one script of pages with moving people, built from ``page/``; three.js is inside it."""
    return (HERE / "assets" / "replay.min.js").read_text(encoding="utf-8")


def _notes(variants: Sequence[dict[str, Any]], notes: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """The notes of the page and those of its variants, each once."""
    own = [(topic, words) for variant in variants for topic, words in variant.get("notes", ())]
    return list(dict.fromkeys([*((topic, words) for topic, words in notes), *own]))


def _page(variants: list[dict[str, Any]], title: str, notes: Sequence[tuple[str, str]]) -> str:
    """The page without its columns. Names are escaped by jinja2, and in JSON by ``tojson``."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    meta = {"format": FORMAT, "opsim": __version__, "title": title, "notes": list(notes), "variants": variants}
    return environment.get_template("replay.html.jinja").render(
        title=title,
        notes=notes,
        meta=meta,
        speeds=SPEEDS,
        style=(HERE / "replay.css").read_text(encoding="utf-8"),
        script=page_script(),
        policy=policy(page_script()),
        columns_here=Markup(_HERE),
    )


def _block(number: int, columns: bytes) -> Iterator[bytes]:
    """The script element of one variant's columns, in pieces; nothing in it is run."""
    packed = gzip.compress(columns, LEVEL, mtime=0)
    yield f'<script type="text/plain" id="columns-{number}">'.encode()
    for start in range(0, len(packed), AT_ONCE):
        yield base64.b64encode(packed[start : start + AT_ONCE])
    yield b"</script>\n"


PRODUCT_COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442", "#7E6BA8")
"""Okabe and Ito's; they come round again."""


def packed(scene: Scene, progress: Callable[[int, int], None] | None = None) -> tuple[dict[str, Any], bytes]:
    """(description of the variant, bytes of its columns); the same for the same scene."""
    columns, trees = Columns(), list[Tree]()
    stands = _tree(trees, scene.standing.skeleton)
    with one_blas_thread():
        models = list(_models(scene, trees, columns, progress or (lambda done, total: None)))
    _add_standing(scene, trees, stands, columns)
    for add in (_add_segments, _add_ways, _add_courses, _add_moves):
        add(scene, columns)
    skeletons = [{"names": list(names), "parents": list(parents)} for names, parents in trees]
    return {**_told(scene), "skeletons": skeletons, "models": models, "columns": columns.table}, columns.close()


def _models(
    scene: Scene, trees: list[Tree], columns: Columns, progress: Callable[[int, int], None]
) -> Iterator[dict[str, Any]]:
    """The entry of each model of performances."""
    for number, drawn in enumerate(scene.performed.drawn):
        yield pack_frames(drawn, _tree(trees, drawn.skeleton), columns, f"m{number}_")
        progress(number + 1, len(scene.performed.drawn))


def _tree(trees: list[Tree], skeleton: Any) -> int:
    """The number of a skeleton; a new one is added."""
    tree = tree_of(skeleton)
    if tree not in trees:
        trees.append(tree)
    return trees.index(tree)


def _told(scene: Scene) -> dict[str, Any]:
    """All that is words or few numbers."""
    return {
        "name": scene.name,
        "title": scene.title,
        "replication": scene.replication,
        "start_s": scene.start_s,
        "low_s": scene.low_s,
        "high_s": scene.high_s,
        "states": [_state(name) for name in scene.states],
        "station_states": [_state(name) for name in scene.station_states],
        "places": [{"name": name, "x": x, "y": y} for name, x, y in scene.places],
        "paths": [list(road) for road in scene.roads],
        "reach": None if scene.reach_m is None else list(scene.reach_m),
        "stations": [
            {
                "name": bench.name,
                "place": bench.place,
                "x": bench.x_m,
                "y": bench.y_m,
                "facing": bench.facing_rad,
                "width_m": bench.width_m,
                "depth_m": bench.depth_m,
                "height_m": bench.height_m,
                "automatic": bench.automatic,
                **({"levels_m": list(bench.levels_m)} if bench.levels_m else {}),
                "buffer": {"x": bench.buffer_m[0], "y": bench.buffer_m[1], "capacity": bench.capacity},
            }
            for bench in scene.benches
        ],
        "stores": [
            {"name": pile.name, "x": pile.x_m, "y": pile.y_m, "capacity": pile.capacity} for pile in scene.piles
        ],
        "belts": [{"name": belt.name, "points": [list(point) for point in belt.points_m]} for belt in scene.belts],
        "products": [
            {"name": name, "colour": PRODUCT_COLOURS[rank % len(PRODUCT_COLOURS)]}
            for rank, name in enumerate(scene.products)
        ],
        "tasks": [{"name": name, "known": known} for name, known in scene.tasks],
        "workers": [{"name": name, "height_m": height_m} for name, height_m in scene.workers],
        "notes": [list(note) for note in scene.notes],
    }


def _state(name: str) -> dict[str, str]:
    return {"name": name, "words": WORDS.get(name, name), "colour": STATE_COLOURS.get(name, OTHER)[0]}


def _add_segments(scene: Scene, columns: Columns) -> None:
    s, performed = scene.segments, scene.performed
    columns.add("seg_first", "u4", s.first)
    for name, dtype, values in (
        ("start_s", "f8", s.start_s), ("state", "u1", s.state), ("station", "i2", s.station), ("task", "i2", s.task),
        ("product", "i2", s.product), ("job", "i4", s.job), ("performance", "i4", s.performance),
        ("from_s", "f4", s.from_s), ("to_s", "f4", s.to_s), ("x", "f4", s.x_m), ("y", "f4", s.y_m),
        ("yaw", "f4", s.yaw_rad), ("way", "i4", s.way),
    ):  # fmt: skip
        columns.add(f"seg_{name}", dtype, values)
    if s.dx_m.any() or s.dy_m.any():
        columns.add("seg_dx", "f4", s.dx_m)
        columns.add("seg_dy", "f4", s.dy_m)
    columns.add("perf_model", "u2", performed.model)
    columns.add("perf_row", "u4", performed.row)
    if scene.rula is not None:
        columns.add("rula", "u1", scene.rula)


def _add_ways(scene: Scene, columns: Columns) -> None:
    ways = scene.ways
    columns.add("way_first", "u4", ways.first)
    for name, values in (
        ("x", ways.x_m), ("y", ways.y_m), ("own_m", ways.own_m), ("yaw_from", ways.yaw_from), ("yaw_to", ways.yaw_to)
    ):  # fmt: skip
        columns.add(f"way_{name}", "f4", values)


def _add_standing(scene: Scene, trees: list[Tree], stands: int, columns: Columns) -> None:
    """Of a skeleton that nobody stands with the posture is left at 0."""
    postures = [np.zeros((len(parents) - 1, 3)) for _, parents in trees]
    postures[stands] = scene.standing.directions
    columns.add("standing", "f4", np.concatenate([posture.ravel() for posture in postures]))
    columns.add("stand_bone_m", "f4", scene.standing.bone_m)
    columns.add("stand_skeleton", "u1", np.full(len(scene.workers), stands))


def _add_courses(scene: Scene, columns: Columns) -> None:
    for prefix, courses, dtypes in (
        ("st", scene.stations, {"queue": "u2", "busy": "u2", "state": "u1"}),
        ("so", scene.stores, {"level": "u2"}),
    ):
        columns.add(f"{prefix}_first", "u4", courses.first)
        columns.add(f"{prefix}_at_s", "f4", courses.at_s)
        for name, dtype in dtypes.items():
            columns.add(f"{prefix}_{name}", dtype, np.minimum(courses.columns[name], 65_535))


def _add_moves(scene: Scene, columns: Columns) -> None:
    moves = scene.moves
    for name, dtype, values in (
        ("start_s", "f4", moves.start_s), ("end_s", "f4", moves.end_s), ("kind", "u1", moves.kind),
        ("worker", "i2", moves.worker), ("product", "i2", moves.product), ("way", "i4", moves.way),
    ):  # fmt: skip
        columns.add(f"mv_{name}", dtype, values)
