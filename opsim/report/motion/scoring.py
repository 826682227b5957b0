"""When movements score how high: the course of the scores of one, and RULA of all as rows along their time.

A page about scored movements: figures, the worst postures drawn with what drives them, and when scores are high.
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path
from string import ascii_uppercase
from typing import Any

import numpy as np

from opsim.ergonomics.angles import AT
from opsim.ergonomics.options import Options
from opsim.ergonomics.scores.explain import explain
from opsim.ergonomics.scores.scoring import bounds_of
from opsim.ergonomics.scores.tables import OWAS_LEVELS, REBA, RULA, Level
from opsim.ergonomics.shift.movement import ALIKE_DEG, ScoredMovement, alike, movement_figures, worst_postures
from opsim.files import write_text
from opsim.report.page import asset, need_matplotlib, template
from opsim.report.plot.plotly import GRID, INK, MUTED
from opsim.report.plot.posture import posture_svg, room_of, warm
from opsim.subjects.exposure.plan import Handling

WIDE_IN, SLIM_IN, PANEL_IN, ROW_IN = 10.6, 4.6, 0.95, 0.17
"""SLIM_IN is for telephones: labels stay as large as they are."""
LEFT_IN, RIGHT_IN = 1.38, 0.16
MOST_ROWS = 40
LEVELS = ("#dfeaf2", "#f7e7b4", "#f0b04a", "#d9692b", "#a8320a")
"""From nothing to be done to at once; RULA and OWAS have four levels, REBA five."""
METHODS = {"rula": ("RULA", RULA, LEVELS[:3] + LEVELS[4:]), "reba": ("REBA", REBA, LEVELS)}
METHODS["owas"] = ("OWAS", OWAS_LEVELS, LEVELS[:3] + LEVELS[4:])
TICKS = {"rula": (1, 3, 5, 7), "reba": (1, 4, 8, 11, 15), "owas": (1, 2, 3, 4)}
LINE = "#1f2328"
Letters = Mapping[tuple[int, int], str]
"""(movement, posture) -> the letter of a posture that is drawn elsewhere."""


def course_svg(scored: Sequence[ScoredMovement], letters: Letters, wide_in: float = WIDE_IN) -> bytes:
    """The scores of the movement of the first letter along time, above RULA of the first 40 movements, as SVG.

    Shaded between at least and at most; the colours are action levels. In rows the lower half is at least, the upper
    half at most. Raises ValueError where matplotlib is not installed.
    """
    need_matplotlib("scores along time")
    from matplotlib.figure import Figure

    first = next(iter(letters), (0, 0))[0]
    rows = list(range(min(len(scored), MOST_ROWS))) if len(scored) > 1 else []
    heights = [0.35, *[PANEL_IN] * 3, 0.42, *([0.5, ROW_IN * len(rows) + 0.02, 0.45] if rows else [])]
    figure = Figure(figsize=(wide_in, sum(heights)), facecolor="white")
    left, wide = LEFT_IN / wide_in, 1 - (LEFT_IN + RIGHT_IN) / wide_in
    tops = 1.0 - np.cumsum([0.0, *heights]) / sum(heights)
    for place, name in enumerate(METHODS):
        box = (left, tops[place + 2] + 0.012, wide, tops[place + 1] - tops[place + 2] - 0.024)
        _draw_course(figure.add_axes(box), scored[first], name, first, letters, last=place == 2)
    title = f"{scored[first].movement.name}: scores along time"
    figure.text(left, 1 - 0.12 / sum(heights), title, size=10, weight="bold", color=INK, va="top", parse_math=False)
    if rows:
        box = (left, tops[7], wide, tops[6] - tops[7])
        _draw_rows(figure.add_axes(box), scored, rows, letters)
        said = (
            "RULA of all, along their time"
            if len(rows) == len(scored)
            else f"RULA of the first {len(rows)} of {len(scored)}"
        )
        figure.text(left, tops[6] + 0.12 / sum(heights), said, size=10, weight="bold", color=INK, va="bottom")
    return _svg(figure)


def _svg(figure: Any) -> bytes:
    """The bytes of a figure: the same whenever and wherever it is drawn."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context({"svg.hashsalt": "opsim", "svg.fonttype": "path"}):
        figure.savefig(stream, format="svg", metadata={"Date": None, "Creator": "opsim"})
    return stream.getvalue()


def level_colour(name: str, value: float) -> str:
    """The colour of the action level of a score."""
    _, levels, colours = METHODS[name]
    return colours[levels.index(level_of(levels, value))]


def level_of(levels: Sequence[Level], value: float) -> Level:
    """The action level of a score; the lowest of one below all."""
    return max((level for level in levels if value >= level.least), default=levels[0], key=lambda level: level.least)


def _draw_course(axes: Any, one: ScoredMovement, name: str, which: int, letters: Letters, *, last: bool) -> None:
    words, levels, colours = METHODS[name]
    movement = one.movement
    edges_s = np.r_[movement.start_s, movement.duration_s]
    low, high = (np.where(movement.known, getattr(one.scores, name)[:, end], np.nan) for end in range(2))
    for level, colour in zip(levels, colours):
        axes.axhspan(level.least - 0.5, level.most + 0.5, color=colour, alpha=0.55, lw=0, zorder=0)
    for bound in (low, high):
        axes.stairs(bound, edges_s, baseline=None, color=LINE, lw=1.1, zorder=4)
    axes.stairs(high, edges_s, baseline=low, fill=True, color=LINE, alpha=0.16, lw=0, zorder=3)
    for (movement_number, posture), letter in letters.items():
        if movement_number == which:
            at_s = movement.start_s[posture] + 0.5 * movement.seconds[posture]
            axes.axvline(at_s, color=LINE, lw=0.8, ls=(0, (2, 2)), zorder=5)
            if name == "rula":
                above = {"ha": "center", "va": "bottom", "size": 9, "weight": "bold", "color": INK}
                axes.text(at_s, levels[-1].most + 0.6, letter, clip_on=False, **above)
    axes.set(xlim=(0, movement.duration_s), ylim=(levels[0].least - 0.5, levels[-1].most + 0.5))
    axes.set_ylabel(words, rotation=0, ha="right", va="center", size=10, weight="bold", color=INK)
    axes.set_yticks(TICKS[name])
    axes.tick_params(labelsize=8, colors=MUTED, labelbottom=last)
    axes.spines[:].set_visible(False)
    if last:
        axes.set_xlabel("time, s", size=9, color=MUTED)


def _draw_rows(axes: Any, scored: Sequence[ScoredMovement], rows: Sequence[int], letters: Letters) -> None:
    for place, which in enumerate(rows):
        for end, top in enumerate((place, place - 0.42)):  # places grow downwards
            _draw_row(axes, scored[which], end, top)
    for (which, posture), letter in letters.items():
        if which in rows:
            at_s = scored[which].movement.start_s[posture] + 0.5 * scored[which].movement.seconds[posture]
            behind = {"boxstyle": "round,pad=0.12", "facecolor": "white", "lw": 0, "alpha": 0.8}
            look = {"size": 8, "weight": "bold", "color": INK, "bbox": behind}
            axes.text(at_s, which, letter, ha="center", va="center", zorder=4, **look)
    longest_s = max(scored[which].movement.duration_s for which in rows)
    axes.set(xlim=(0, longest_s), ylim=(len(rows) - 0.5, -0.5))
    axes.set_yticks(range(len(rows)), [_short(scored[which].movement.name) for which in rows], parse_math=False)
    axes.tick_params(labelsize=8, colors=MUTED, length=0)
    axes.set_xlabel("time, s", size=9, color=MUTED)
    axes.grid(axis="x", color=GRID, lw=0.6, zorder=1)
    axes.spines[:].set_visible(False)


def _draw_row(axes: Any, one: ScoredMovement, end: int, top: float) -> None:
    """Half a row, of at least (end 0) or at most (end 1)."""
    movement, scores = one.movement, one.scores.rula[:, end].tolist()
    colours = [level_colour("rula", score) if known else "#ffffff" for score, known in zip(scores, movement.known)]
    edges_s = np.r_[movement.start_s, movement.duration_s]
    for first, last in pairwise(
        [k for k in range(len(colours) + 1) if k in (0, len(colours)) or colours[k] != colours[k - 1]]
    ):
        bar = [(edges_s[first], edges_s[last] - edges_s[first])]
        axes.broken_barh(bar, (top, 0.42), facecolors=colours[first], lw=0, zorder=2)


def _short(name: str) -> str:
    return name if len(name) <= 18 else f"{name[:17]}…"


DRAWN = 6
VIEWS = ("side", "three_quarter")
PARTS = {
    "trunk": "trunk", "back": "back", "neck": "neck", "arms": "arms", "legs": "legs", "upper_arm": "upper arm",
    "lower_arm": "lower arm", "wrist": "wrist", "wrists": "wrists", "wrist_twist": "twist of forearm",
    "load": "load", "coupling": "grip", "time": "held or repeated",
}  # fmt: skip
ANGLES = {
    "trunk_flexion": ("trunk flexed", "trunk bent back"),
    "trunk_side": ("bent to the left", "bent to the right"),
    "trunk_twist": ("twisted to the left", "twisted to the right"),
    "neck_flexion": ("neck flexed", "neck extended"),
}
OF_SIDE = {
    "arm_flexion": ("upper arm flexed", "upper arm behind"),
    "arm_abduction": ("abducted", "adducted"),
    "elbow": ("elbow bent", ""),
    "wrist": ("wrist bent", ""),
}
"""Words for angles above and below 0."""


@dataclass(frozen=True)
class Said:
    """What the page is about: its title, the skeleton of all postures, what was said of the task, how it was scored."""

    title: str
    skeleton: Any
    handling: Handling
    options: Options
    repeated: bool
    notes: Sequence[str]
    walking: bool = False


def write_scored(out: Path, said: Said, scored: Sequence[ScoredMovement]) -> None:
    """Write the page, one file that fetches nothing."""
    write_text(out, page(said, scored))


def page(said: Said, scored: Sequence[ScoredMovement]) -> str:
    """The page's HTML."""
    worst = list(worst_postures(scored, DRAWN))
    letters = dict(zip(worst, ascii_uppercase))
    cards = [
        _card(said, scored[which], posture, letter) | {"like": _like(scored, which, posture)}
        for (which, posture), letter in letters.items()
    ]
    return template("scored.html.jinja").render(
        title=said.title,
        style=asset("report.css"),
        figures=[figure.row for figure in movement_figures(scored)],
        cards=_with_pictures(said, cards),
        course=course_svg(scored, letters).decode(),
        course_slim=course_svg(scored, letters, SLIM_IN).decode(),
        levels=[(words, list(zip(levels, colours))) for words, levels, colours in METHODS.values()],
        drives=[(f"{points:g}", warm(points)) for points in (0.0, 0.5, 1.0, 2.0)],
        options=_options(said.options),
        notes=said.notes,
    )


def _card(said: Said, one: ScoredMovement, posture: int, letter: str) -> dict[str, Any]:
    """All that is told of one posture, and its joints."""
    movement, measures = one.movement, one.movement.measures[posture]
    bounds, static = bounds_of(said.handling, walking=said.walking), bool(one.static[posture])
    full = movement.full(posture)
    why = explain(measures, bounds, said.options, repeated=said.repeated, static=static, carrying=full)
    side = str(why["rula"]["side"])
    return {
        "letter": letter,
        "where": f"{movement.name}, at {movement.start_s[posture] + 0.5 * movement.seconds[posture]:.2f} s",
        "badges": [_badge(name, why[name]) for name in METHODS],
        "side": side,
        "rows": _rows(why),
        "owas": {PARTS[part]: _codes(codes) for part, codes in why["owas"]["parts"].items()},
        "drives": _drives(why["rula"]["drives"]),
        "angles": _angles(measures, side),
        "drawn_by": why["rula"]["drives"],
        "joints": movement.body(posture),
        "load_kg": said.handling.load_kg if full else None,
        "hands": "" if movement.carrying is None else "the load in the hands" if full else "nothing in the hands",
    }


def _like(scored: Sequence[ScoredMovement], which: int, posture: int) -> str:
    """For how long postures are like this one, and in how many movements."""
    same = alike(scored, which, posture)
    seconds = sum(float(one.movement.seconds[rows].sum()) for one, rows in zip(scored, same))
    n = sum(bool(rows.any()) for rows in same)
    more = f", in {n} of {len(scored)} movements" if len(scored) > 1 else ""
    return f"Postures like it (angles within {ALIKE_DEG:.0f}°): {seconds:.1f} s{more}"


def _with_pictures(said: Said, cards: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Each card with its posture from two sides, all on one scale."""
    if not cards:
        return []
    joints = [card["joints"] for card in cards]
    for card in cards:
        look = {"drives": card["drawn_by"], "side": card["side"], "load_kg": card["load_kg"]}
        label = f"posture {card['letter']}: {', '.join(angle for angle in card['angles'])}"
        rooms = {view: room_of(joints, said.skeleton, view, card["side"]) for view in VIEWS}
        card["pictures"] = [
            posture_svg(card["joints"], said.skeleton, view=view, room=rooms[view], label=label, **look)
            for view in VIEWS
        ]
    return list(cards)


def _badge(name: str, why: Mapping[str, Any]) -> dict[str, Any]:
    """A chip in the colours of both ends, and the words of both where they are of different levels."""
    words, levels, _ = METHODS[name]
    low, high = (level_of(levels, score) for score in why["score"])
    colours = [level_colour(name, score) for score in why["score"]]
    text = high.text if low == high else f"at least: {low.text}; at most: {high.text}"
    return {"words": words, "score": _pair(why["score"]), "colours": colours, "text": text}


def _rows(why: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Part, RULA's and REBA's sub-score of it."""
    rula, reba = dict(why["rula"]["parts"]), why["reba"]["parts"]
    rula["load"] = rula.pop("force")
    return [
        (words, _pair(rula[part]) if part in rula else "", _pair(reba[part]) if part in reba else "")
        for part, words in PARTS.items()
        if part in rula or part in reba
    ]


def _drives(drives: Mapping[str, float]) -> list[tuple[str, str, str]]:
    """Part, points it brings into RULA, its colour; the most first."""
    return [(PARTS[part], f"{points:+.1f}", warm(points)) for part, points in drives.items() if abs(points) >= 0.05]


def _angles(measures: Any, side: str) -> list[str]:
    """In words, of those that are known and not next to nothing; of the worse arm."""
    wanted = ANGLES | {f"{side}_{name}": words for name, words in OF_SIDE.items()}
    found = [(words, float(measures[AT[name]])) for name, words in wanted.items()]
    return [f"{words[degrees < 0]} {abs(degrees):.0f}°" for words, degrees in found if abs(degrees) >= 5]


def _codes(codes: Sequence[int]) -> str:
    return " or ".join(map(str, codes))


def _pair(pair: tuple[int, int]) -> str:
    return str(pair[0]) if pair[0] == pair[1] else f"{pair[0]} to {pair[1]}"


def _options(options: Options) -> list[tuple[str, str]]:
    """Every option and threshold by name, so that the page says how it was made."""
    plain = asdict(options)
    plain |= {f"threshold {name}": value for name, value in plain.pop("thresholds").items()}
    plain.pop("waiting")
    return [(name.replace("_", " "), _option(value)) for name, value in plain.items()]


def _option(value: Any) -> str:
    if isinstance(value, tuple):
        return ", ".join(value) or "none"
    return (
        ("on" if value else "off")
        if isinstance(value, bool)
        else f"{value:g}"
        if isinstance(value, float)
        else str(value)
    )
