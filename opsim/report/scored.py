"""A page about scored movements: figures, the worst postures drawn with what drives them, and when scores are high."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from string import ascii_uppercase
from typing import Any

from opsim.ergonomics.columns import AT
from opsim.ergonomics.options import Options
from opsim.ergonomics.scores.bounds import bounds_of
from opsim.ergonomics.scores.explained import explain
from opsim.ergonomics.shift.movement import ALIKE_DEG, ScoredMovement, alike, worst_postures
from opsim.ergonomics.shift.movement_figures import movement_figures
from opsim.plan.handling import Handling
from opsim.report.course_picture import METHODS, SLIM_IN, course_svg, level_colour, level_of
from opsim.report.offline import asset, template
from opsim.report.posture_picture import posture_svg, room_of, warm
from opsim.whole import write_text

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
