"""The movements behind the times of emulated tasks, as strips of figures, with what they were learned from.

Stick-figure strips: performances of a task drawn as people along real time, the mean above the samples.

Performances made ready to be looked at side by side, each by the same steps, so that only the movement differs.

Times behind which no movement stands.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.report.material import Material
from opsim.report.numbers import listing, quantity
from opsim.report.page import Grid, Legend, Picture, Section, Words
from opsim.report.plot.body import LEFT, RIGHT, TRUNK, Stage, Strip, draw_person, stage_of
from opsim.report.plot.svg_canvas import figure_of
from opsim.task_model import behind

if TYPE_CHECKING:
    from opsim.scenario.schema.scenario import Loaded
    from opsim.task_model import TaskModel

SAMPLES = 2
MANY = 20
"""Figures in a row where a task is several motions."""
SAID = (
    "These tasks take their time from a motion emulator: posture, pace and duration come from one draw. Above, the "
    "mean performance (of several motions in a row a typical one); below, single draws. Figures stand at their real "
    "time."
)
LIMBS = Legend([(LEFT, "left limbs"), (RIGHT, "right limbs")])
Task = Mapping[str, Any]


def movements_section(material: Material) -> Section | None:
    """The emulated tasks, those of one model together with one strip."""
    groups = groups_of(material.summary.get("tasks", []))
    pictures = [_picture(tasks, _strip(material, key, tasks[0])) for key, tasks in groups.items()]
    if not pictures:
        return None
    return Section("movements", "Movements behind the times", [Words(SAID), LIMBS, *pictures], "Movements")


def groups_of(tasks: Sequence[Task]) -> dict[tuple[str, str], list[Task]]:
    """The emulated tasks by (library, task of the library)."""
    groups: dict[tuple[str, str], list[Task]] = {}
    for task in tasks:
        if task.get("emulated"):
            groups.setdefault((task.get("library", ""), task.get("library_task", task["model"])), []).append(task)
    return groups


def origin_of(what: str, source: Mapping[str, Any]) -> str:
    """What stands behind an emulator: recordings of how many people, whose, under which licence, in which file."""
    recorded = behind(source["source"], source["n_sequences"], source["n_workers"])
    licence = f" · Licence: {source['licence']}" if source.get("licence") else ""
    return f"{what}: {recorded}. {source['source']}{licence} · {source['library']}"


def _picture(tasks: Sequence[Task], strip: bytes) -> Picture:
    first = tasks[0]
    shown_as = first["library_task"] or first["model"]
    said = f"Stick figures of {shown_as} along real time: the mean performance above single draws"
    caption = origin_of(f"mean {quantity(first['mean_s'], 's')}", first)
    return Picture(strip, said, listing([task["task"] for task in tasks]), f"as {shown_as}", caption)


def _strip(material: Material, key: tuple[str, str], task: Task) -> bytes:
    """Drawn once for all variants of a run."""
    if key not in material.pictures:
        material.pictures[key] = _drawn(material.loaded, task)
    return material.pictures[key]


def _drawn(loaded: Loaded, task: Task) -> bytes:
    from opsim.libraries import load_library, resolve_library
    from opsim.scenario.schema import Motions
    from opsim.subjects.tasks.from_scenario import motions_model

    said = loaded.scenario.tasks[task["task"]]
    if isinstance(said, Motions):
        return draw_strips(motions_model(said, loaded), n_samples=SAMPLES, n_figures=MANY)
    model = load_library(resolve_library(task["library"], loaded.folder))[task["library_task"]]
    return draw_strips(model, n_samples=SAMPLES)


PALE = "#6b737d"
WIDE_IN = 11.0
_LETTER_IN, _LINE_IN = 0.062, 0.135
MOST_LINES = 8
"""Of words of marks below a row; what has no room on them is counted in a note."""


def draw_strips(
    model: TaskModel | Sequence[Strip],
    path: str | Path | None = None,
    *,
    n_samples: int = 3,
    seed: int = 0,
    skeleton: Any = None,
    mark_names: Sequence[str] = (),
    title: str = "",
    n_figures: int = 11,
) -> bytes:
    """Strips of a task model (mean above ``n_samples`` drawn performances), or of given rows, as PNG or SVG.

    model      : anything that satisfies the TaskModel seam and has postures, or the rows (then with ``skeleton``)
    path       : where to write; its ending says png or svg. None: nothing is written, the bytes are SVG
    n_figures  : figures in the longest row; the others stand as close in time, so a short row is a quick performance
    returns    : the bytes of the picture; the same for the same arguments
    Raises ValueError where the model has no postures, or where the ending is neither png nor svg.
    """
    ending = "svg" if path is None else Path(path).suffix.lower().lstrip(".")
    if ending not in ("png", "svg"):
        raise ValueError(f"strips are drawn as .png or .svg, found {str(path)!r}")
    if not isinstance(model, Sequence):
        skeleton = getattr(model, "skeleton", skeleton)
        mark_names = mark_names or tuple(getattr(model, "mark_names", ()))
        model = strips_of(model, n_samples=n_samples, seed=seed)
    picture = render(_figure(model, skeleton, mark_names, title, n_figures, ending), ending)
    if path is not None:
        Path(path).write_bytes(picture)
    return picture


def strips_of(model: TaskModel, *, n_samples: int = 3, seed: int = 0, n_times: int | None = None) -> list[Strip]:
    """The mean performance and ``n_samples`` drawn ones; the mean posture is that of 64 other draws.

    Of a model that has a ``typical`` performance instead of a mean one, that.
    n_times : postures along each; None: 61, or five a second where a performance is long
    """
    many: Any = model.sample(64, np.random.default_rng([seed, 1]))
    if getattr(many, "skeleton", None) is None:
        raise ValueError("this task model has durations only: there is no posture to draw")
    mean_s = float(model.mean_duration_s())
    if n_times is None:
        n_times = max(61, min(int(np.ceil(5 * mean_s)) + 1, 601))
    few: Any = model.sample(max(n_samples, 1), np.random.default_rng(seed))
    drawn = few.positions_m(n_times=n_times)
    samples = [
        Strip(f"sample {i + 1}", drawn[i], float(few.duration_s[i]), np.asarray(few.mark_s[i]))
        for i in range(n_samples)
    ]
    typical = getattr(model, "typical", None)
    first = _mean_strip(many, mean_s, n_times) if typical is None else _typical_strip(typical(), n_times)
    return [first, *samples]


def _typical_strip(one: Any, n_times: int) -> Strip:
    """The only performance of a block."""
    positions = one.positions_m(n_times=n_times)[0]
    return Strip("typical performance", positions, float(one.duration_s[0]), np.asarray(one.mark_s[0]))


def _mean_strip(performances: Any, duration_s: float, n_times: int) -> Strip:
    """Mean directions (made unit again), mean bones, mean path: averaging points would shorten swinging limbs."""
    skeleton, positions = performances.skeleton, performances.positions_m(n_times=n_times)
    mean = skeleton.directions(positions).mean(axis=0)
    mean /= np.linalg.norm(mean, axis=-1, keepdims=True)
    bones = skeleton.bone_lengths(positions).mean(axis=(0, 1))
    root = positions[:, :, skeleton.parents.index(-1)].mean(axis=0)
    share = np.mean(np.asarray(performances.mark_s) / np.asarray(performances.duration_s)[:, None], axis=0)
    return Strip("mean performance", skeleton.positions(mean, bones, root), duration_s, share * duration_s)


def _figure(
    strips: Sequence[Strip], skeleton: Any, mark_names: Sequence[str], title: str, n_figures: int, ending: str = "svg"
) -> Any:
    if skeleton is None:
        raise ValueError("strips need the skeleton of their postures")
    stage = stage_of(strips, skeleton, n_figures)
    height_m = max(strip.positions_m[..., 2].max() for strip in strips) + 0.32
    longest_m = stage.m_per_s * max(strip.duration_s for strip in strips)
    left_m, right_m = 0.75 * stage.m_per_s * stage.step_s, 0.6 * stage.m_per_s * stage.step_s
    wide_m = longest_m + left_m + right_m
    inches = WIDE_IN / wide_m
    line_m = _LINE_IN / inches
    words = [_words(strip, mark_names, stage.m_per_s, -left_m, longest_m + right_m) for strip in strips]
    n_lines = max((1 + (MOST_LINES if word.line is None else word.line) for row in words for word in row), default=0)
    below_m = max(0.55, _first_line_m(line_m) + (n_lines + 1) * line_m)
    tall_m = height_m + 0.07 + below_m
    title_in = 0.42 if title else 0.08
    figure = figure_of(ending, (WIDE_IN, inches * tall_m * len(strips) + title_in))
    share = 1.0 - title_in / figure.get_figheight()
    for row, strip in enumerate(strips):
        axes = figure.add_axes((0.0, share * (1 - (row + 1) / len(strips)), 1.0, share / len(strips)))
        axes.set(xlim=(-left_m, longest_m + right_m), ylim=(-below_m, height_m + 0.07), aspect="equal")
        axes.axis("off")
        _draw_row(axes, strip, stage, words[row], line_m, is_mean=row == 0)
    if title:
        figure.text(0.012, 1 - 0.1 / figure.get_figheight(), title, va="top", size=12, weight="bold", parse_math=False)
        _legend(figure)
    return figure


def _legend(figure: Any) -> None:
    top = 1 - 0.12 / figure.get_figheight()
    figure.text(0.988, top, "right limbs", va="top", ha="right", size=9, color=RIGHT)
    figure.text(0.918, top, "left limbs", va="top", ha="right", size=9, color=LEFT)


def _draw_row(axes: Any, strip: Strip, stage: Stage, placed: Sequence[_Word], line_m: float, *, is_mean: bool) -> None:
    floor = float(np.quantile(strip.positions_m[..., 2].min(axis=1), 0.1))
    end_m, step_m = strip.duration_s * stage.m_per_s, stage.step_s * stage.m_per_s
    axes.plot([-step_m / 2, end_m], [floor - 0.02] * 2, color="#aab0b8", lw=1.2, zorder=1)
    axes.plot([end_m] * 2, [floor - 0.1, floor + 0.06], color="#aab0b8", lw=1.2, zorder=1)
    times = np.arange(0.0, strip.duration_s + 1e-9, stage.step_s)
    if strip.duration_s - times[-1] > 0.7 * stage.step_s:
        times = np.append(times, strip.duration_s)
    for at_s in times:
        at_m = at_s * stage.m_per_s
        axes.text(at_m, floor - 0.15, _seconds(at_s), ha="center", va="top", size=8, color=PALE)
        draw_person(axes, *stage.flat(strip, at_s), at_m, stage.skeleton)
    words = {"ha": "left", "va": "top", "size": 10, "weight": "bold" if is_mean else "normal", "color": TRUNK}
    top = axes.get_ylim()[1] - 0.02
    axes.text(-step_m / 2, top, f"{strip.label}: {strip.duration_s:.2f} s", parse_math=False, **words)
    _draw_marks(axes, placed, floor, line_m)


def _first_line_m(line_m: float) -> float:
    """How far below the floor the words of marks begin, where a line is so high: below the times."""
    return max(0.32, 0.15 + 1.1 * line_m)


@dataclass(frozen=True)
class _Word:
    """The words of a mark on a line below the floor; ``line`` is None where there is no room even on the last."""

    words: str
    mark_m: float
    at_m: float
    line: int | None


def _words(strip: Strip, mark_names: Sequence[str], m_per_s: float, left_m: float, right_m: float) -> list[_Word]:
    """Where the words of each mark of a row stand: on the first line that is free there, for as many lines as needed.

    left_m, right_m : the row's ends
    """
    letter_m = _LETTER_IN * (right_m - left_m) / WIDE_IN
    ends_m: list[float] = []
    placed = []
    named = zip([*mark_names, *[""] * strip.mark_s.size], strip.mark_s)
    for name, mark_s in sorted(named, key=lambda each: float(each[1])):
        words, mark_m = f"{name} {mark_s:.2f} s".strip(), float(mark_s) * m_per_s
        half_m = 0.5 * letter_m * len(words)
        at_m = float(np.clip(mark_m, left_m + half_m, max(right_m - half_m, left_m + half_m)))
        line = next((i for i, end_m in enumerate(ends_m) if at_m - half_m > end_m), len(ends_m))
        if line < MOST_LINES:
            ends_m[line:] = [at_m + half_m + letter_m, *ends_m[line + 1 :]]
        placed.append(_Word(words, mark_m, at_m, line if line < MOST_LINES else None))
    return placed


def _draw_marks(axes: Any, placed: Sequence[_Word], floor: float, line_m: float) -> None:
    """A triangle for each mark, tied to its words; how many have none is said on the last line."""
    look: Any = {"va": "top", "size": 8, "color": TRUNK, "parse_math": False, "zorder": 41}
    paper: Any = {"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    for word in placed:
        axes.plot([word.mark_m], [floor - 0.075], marker="^", ms=5, color="#111111", zorder=40)
        if word.line is not None:
            down_m = floor - _first_line_m(line_m) - word.line * line_m
            if word.line:
                axes.plot([word.mark_m] * 2, [floor - 0.1, down_m], color="#c9ced6", lw=0.6, zorder=0.5)
            axes.text(word.at_m, down_m, word.words, ha="center", bbox=paper, **look)
    without = sum(word.line is None for word in placed)
    if without:
        down_m = floor - _first_line_m(line_m) - MOST_LINES * line_m
        words = f"and {without} more mark{'s' * (without > 1)}, for whose words there is no room"
        axes.text(axes.get_xlim()[0] + 0.1, down_m, words, ha="left", **look)


def _seconds(at_s: float) -> str:
    return f"{at_s:.2f}".rstrip("0").rstrip(".") + " s"


def render(figure: Any, ending: str) -> bytes:
    """The bytes of a sheet of ``figure_of``."""
    if ending == "svg":
        return bytes(figure.svg())
    stream = io.BytesIO()
    figure.savefig(stream, format=ending, dpi=150, metadata={"Software": "opsim"})
    return stream.getvalue()


CARD_RATE_HZ = 30.0
"""Frames a second of what is shown."""
FLOOR_QUANTILE = 0.1
"""The floor lies under the lowest joint, where it is this low or lower in this share of the frames."""


@dataclass(frozen=True, eq=False)
class Card:
    """One performance to look at: ``positions_m`` (T, J, 3) at RATE_HZ, recorded or not, and who it is, in words."""

    positions_m: np.ndarray
    is_real: bool
    who: str

    @property
    def duration_s(self) -> float:
        return (len(self.positions_m) - 1) / CARD_RATE_HZ


def staged(positions_m: np.ndarray, rate_hz: float, skeleton: Any) -> np.ndarray:
    """Joints (T, J, 3) at ``rate_hz`` as a Card has them: RATE_HZ, first root at x = y = 0, first heading along x.

    The lowest joint stands on z = 0. Bodies keep the sizes they have.
    """
    shown = resampled(np.asarray(positions_m, float), rate_hz)
    start = shown[0, skeleton.parents.index(-1), :2]
    shown = _turned(shown - np.append(start, 0.0), -_heading_rad(shown[0], skeleton.names))
    shown[..., 2] -= np.quantile(shown[..., 2].min(axis=1), FLOOR_QUANTILE)
    return shown


def resampled(positions_m: np.ndarray, rate_hz: float) -> np.ndarray:
    """(T, J, 3) at ``rate_hz`` -> (T', J, 3) at RATE_HZ, linear between frames; the end to half a frame."""
    duration_s = (len(positions_m) - 1) / rate_hz
    time_s = np.arange(max(round(duration_s * CARD_RATE_HZ), 1) + 1) / CARD_RATE_HZ
    place = np.minimum(time_s * rate_hz, len(positions_m) - 1.0)
    low = np.minimum(place.astype(int), len(positions_m) - 2)
    share = (place - low)[:, None, None]
    return (1 - share) * positions_m[low] + share * positions_m[low + 1]


def _heading_rad(posture_m: np.ndarray, names: Sequence[str]) -> float:
    """Where one posture (J, 3) looks: across its hip line, 0 along x; 0 for a skeleton without hips."""
    if not {"left_hip", "right_hip"} <= set(names):
        return 0.0
    left = posture_m[list(names).index("left_hip")] - posture_m[list(names).index("right_hip")]
    return float(np.arctan2(-left[0], left[1]))


def _turned(points: np.ndarray, angle_rad: float) -> np.ndarray:
    """Points (..., 3) turned about the vertical, x towards y."""
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


SYNTHETIC = "No movement stands behind these times: they are given in the scenario."


def synthetic_times_section(material: Material) -> Section | None:
    """Every task that is not emulated, with its model of time."""
    tasks = [task for task in material.summary.get("tasks", []) if not task.get("emulated")]
    rows = [
        (task["task"], task["station"], task["model"], quantity(task["mean_s"], "s"), _tag(task["model"]))
        for task in tasks
    ]
    columns = ("Task", "Station", "Time model", "Mean", "From")
    table = Grid(columns, rows, "", words=3, left=(4,), tags=(4,), said="times without recordings")
    return Section("made-up", "Times without recordings", [Words(SYNTHETIC), table], "Assumed times") if rows else None


def _tag(model: str) -> str:
    return "times from a file" if model.startswith("recorded") else "given in the scenario"
