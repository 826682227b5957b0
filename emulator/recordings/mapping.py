"""A user's own names of joints: lines ``file_name: joint`` or ``file_name,joint``; ``-`` leaves a joint out.

From a file's joints, keypoints or markers to the canonical skeleton: by rules, by a mapping file, and made anew.

Joints that mean nothing here are left out, and their children hang on the nearest ancestor that is kept. Joints without
which no trunk and no heading can be had are made where the body tells them. Everything is said in the report.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from emulator.recordings.joint_names import MappedJoint, MappingReport, bare_name, joints_of, known_words
from emulator.recordings.markers import (
    depths,
    hung_as_bodies_are,
    hung_as_in_the_file,
    joints_from_markers,
    without_length,
)
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError, quoted, text_lines
from emulator.skeleton import CANONICAL, EXTRA

LEFT_OUT = "-"
_HEADER = re.compile(
    r"^(name|file_name|marker|joint|from)\s*[,:]\s*(joint|canonical|canonical_name|to)$", re.IGNORECASE
)


def read_mapping(path: Path, names: Sequence[str]) -> dict[str, str]:
    """Of each joint of the file that the mapping names, its canonical name, or ``-`` where it is left out.

    names : the joints there are
    Raises RecordingError with every wrong line: its number, what was found, the nearest right word.
    """
    mapping: dict[str, str] = {}
    first: dict[tuple[str, str], int] = {}
    wrong = []
    for number, line in text_lines(path):
        text = line.split("#", 1)[0].strip()
        if not text or _HEADER.match(text):
            continue
        name, joint = _parts(text)
        problems = _problems(name, joint, names)
        said = [("name", name)] + ([] if joint == LEFT_OUT else [("joint", joint)])
        for word in said:
            if not problems and word in first:
                problems = [f"found the {word[0]} {quoted(word[1])} a second time, first in line {first[word]}"]
        wrong += [f"{path}:{number}: {problem}" for problem in problems]
        mapping[name] = joint
        for word in said:
            first.setdefault(word, number)
    if not first and not wrong:
        wrong.append(f"{path}: found no line, expected lines such as 'Bip01 L Thigh: left_hip'")
    if wrong:
        raise RecordingError("\n".join(wrong))
    return mapping


def _parts(text: str) -> tuple[str, str]:
    """Cut at the last colon or comma: names can hold colons themselves."""
    found = re.match(r"^(.*)[:,\t]\s*([^:,\t]*)$", text)
    return (found.group(1).strip().strip('"'), found.group(2).strip().strip('"')) if found else (text, "")


def _problems(name: str, joint: str, names: Sequence[str]) -> list[str]:
    if not joint:
        return [f"found {quoted(name)}, expected 'name in the file: joint'"]
    problems = []
    if name not in names:
        problems.append(f"no joint {quoted(name)} in the recording{_near(name, names)}")
    if joint not in (*CANONICAL, *EXTRA, LEFT_OUT):
        problems.append(f"no joint is called {quoted(joint)}{_near(joint, (*CANONICAL, *EXTRA))}")
    return problems


def _near(word: str, known: Sequence[str]) -> str:
    near = get_close_matches(word, known, n=1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else f"; known: {', '.join(list(known)[:12])}"


NEEDED = ("pelvis", "neck", "left_hip", "right_hip", "left_shoulder", "right_shoulder")
"""Joints without which there is neither heading nor trunk."""
_MADE = {
    "pelvis": (("left_hip", "right_hip"),),
    "neck": (("left_shoulder", "right_shoulder"), ("left_clavicle", "right_clavicle")),
    "head": (("left_ear", "right_ear"), ("left_eye", "right_eye"), ("nose",), ("top",)),
    "left_hand": (("left_index", "left_pinky"),),
    "right_hand": (("right_index", "right_pinky"),),
}
"""Joints that can be made, as the middle of the first of these that are all there."""
_PULL, _STEPS = 0.1, 20
"""How strongly a made neck is drawn to the middle of the shoulders against keeping its bones, and steps."""


def mapped(take: Take, mapping_file: Path | None = None, *, where: str = "") -> tuple[Take, MappingReport]:
    """The take with canonical joints (pelvis first, as in ``CANONICAL``, then ``EXTRA``), and what became of each.

    mapping_file : names for joints that the rules do not know, or know wrongly; see ``read_mapping``
    where        : the file, for messages
    Raises RecordingError for mistakes in the mapping file, and where needed joints are neither there nor to be made.
    """
    if mapping_file is None:
        _refuse_several(take.names, where)
        from_markers = joints_from_markers(take)
        if from_markers is not None:
            _refuse_missing(from_markers[0].names, from_markers[1], where)
            return _with_bones(*from_markers)
        given: dict[str, str] = {}
    else:
        given = read_mapping(Path(mapping_file), take.names)
    joints = _named(take, given)
    places, rows = _kept(take, joints, given)
    made, more = _made(take, joints, places)
    _refuse_missing([*places, *made], rows, where)
    return _with_bones(_assembled(take, places, made), [*rows, *more])


def _refuse_several(names: Sequence[str], where: str) -> None:
    """Two people whose points differ by the name in front only (``Ana:LFHD``, ``Ben:LFHD``) are no one body."""
    bodies: dict[str, set[str]] = {}
    for name in names:
        before, _, point = name.rpartition(":")
        bodies.setdefault(point, set()).add(before)
    several = {tuple(sorted(before)) for before in bodies.values() if len(before) > 1}
    if several:
        found = sorted({name or "one without a name" for names in several for name in names})
        raise RecordingError(
            f"{where}: found points of {len(found)} bodies ({', '.join(found[:6])}), expected one; export one alone, "
            "or name the points of one with --map and leave out the others (-)"
        )


def _named(take: Take, given: dict[str, str]) -> list[str]:
    """What each joint means: as the mapping file says, else by the rules without what the file has already taken."""
    if set(take.names) <= {*CANONICAL, *EXTRA}:
        found: Sequence[str] = take.names
    else:
        found = joints_of(take.names, None if take.parents is None else depths(take.parents))
    taken = set(given.values())
    return [given.get(name, "other" if joint in taken else joint) for name, joint in zip(take.names, found)]


def _kept(take: Take, joints: list[str], given: dict[str, str]) -> tuple[dict[str, int], list[MappedJoint]]:
    places, rows = {}, []
    for i, (name, joint) in enumerate(zip(take.names, joints)):
        if joint in (*CANONICAL, *EXTRA):
            places[joint] = i
            rows.append(MappedJoint(name, "kept", joint, "mapping file" if name in given else ""))
        elif joint:
            rows.append(MappedJoint(name, "left out", "", "mapping file" if joint == LEFT_OUT else "no joint here"))
        else:
            near = get_close_matches(bare_name(name).lower(), known_words(), n=1, cutoff=0.6)
            rows.append(MappedJoint(name, "unknown", "", f"nearest: {near[0]}" if near else ""))
    return places, rows


def _made(take: Take, joints: list[str], places: dict[str, int]) -> tuple[dict[str, np.ndarray], list[MappedJoint]]:
    made, rows = {}, []
    for joint, ways in _MADE.items():
        way = next((way for way in ways if all(each in joints for each in way)), None)
        if joint in places or way is None:
            continue
        at = [joints.index(each) for each in way]
        made[joint] = take.positions_m[:, at].mean(axis=1)
        why = f"{'middle of ' if len(way) > 1 else ''}{' and '.join(take.names[i] for i in at)}"
        rows.append(MappedJoint("", "made", joint, why))
    if "neck" in made:
        places_m = {joint: take.positions_m[:, at] for joint, at in places.items()} | made
        below = next((joint for joint in ("upper_chest", "chest", "spine", "pelvis") if joint in places_m), "")
        made["neck"] = _steady_neck(made["neck"], places_m.get(below), places_m.get("head"))
        more = f", at a steady way from {below}" if below else ""
        rows = [replace(row, why=f"{row.why}{more}") if row.joint == "neck" else row for row in rows]
    return made, rows


def _steady_neck(middle: np.ndarray, below: np.ndarray | None, head: np.ndarray | None) -> np.ndarray:
    """The neck (T, 3) near the middle of the shoulders, as far from the joint below as in the median frame.

    And nearly so from the head.

    Shoulders rise and close about the neck: their middle leaves it by 5 % of its bone in lifting the arms, and the bone
    to the head by 3 %; so placed 0 and 0.5 %, where a real neck has 0.4 and 0.9 %.
    """
    neck = middle.copy()
    ends = [
        (end, float(np.nanmedian(np.linalg.norm(middle - end, axis=-1))))
        for end in (below, head)
        if end is not None and _apart(end, middle)
    ]
    for _ in range(_STEPS if len(ends) == 2 else 0):  # Gauss and Newton, drawn to the middle
        normal = np.broadcast_to(_PULL * np.eye(3), (len(neck), 3, 3)).copy()
        pull = _PULL * (middle - neck)
        for end, length_m in ends:
            along = neck - end
            far = np.linalg.norm(along, axis=-1, keepdims=True)
            unit = np.where(np.isfinite(far) & (far > 0), along / np.where(far > 0, far, 1.0), 0.0)
            normal += unit[:, :, None] * unit[:, None, :]
            pull -= np.where(np.isfinite(far), far - length_m, 0.0) * unit
        neck = neck + np.linalg.solve(normal, pull[..., None])[..., 0]
    if below is None or not _apart(below, middle):
        return neck
    along, length_m = neck - below, ends[0][1]
    steady = below + along * (length_m / np.linalg.norm(along, axis=-1, keepdims=True))
    return np.where(np.isfinite(below), steady, neck)


def _apart(end: np.ndarray, middle: np.ndarray) -> bool:
    """Whether a joint is seen together with the neck in some frame, and never lies where it does."""
    far = np.linalg.norm(end - middle, axis=-1)
    return bool(np.isfinite(far).any() and np.nanmin(far) > 0)


def _assembled(take: Take, places: dict[str, int], made: dict[str, np.ndarray]) -> Take:
    joints = [joint for joint in (*CANONICAL, *EXTRA) if joint in places or joint in made]
    positions = np.empty((take.n_frames, len(joints), 3))
    for i, joint in enumerate(joints):
        positions[:, i] = made[joint] if joint in made else take.positions_m[:, places[joint]]
    parents = None
    if take.parents is not None and not {"pelvis", "neck"} & set(made) and not set(made) & set(joints[5:]):
        own = hung_as_in_the_file(take.parents, [places[joint] for joint in joints if joint in places])
        parents = own if own is not None and len(own) == len(joints) and own[0] == -1 else None
    return replace(
        take,
        names=tuple(joints),
        parents=parents if parents is not None else hung_as_bodies_are(joints),
        positions_m=positions,
    )


def _refuse_missing(joints: Sequence[str], rows: list[MappedJoint], where: str) -> None:
    missing = [joint for joint in NEEDED if joint not in joints]
    if not missing:
        return
    unknown = [f"{row.name[:40]!r}{f' ({row.why})' if row.why else ''}" for row in rows if row.became == "unknown"]
    raise RecordingError(
        f"{where}: found no {', '.join(missing)}, expected them for trunk and heading; name them with --map"
        + (f"; unknown: {', '.join(unknown[:20])}{', ...' if len(unknown) > 20 else ''}" if unknown else "")
    )


def _with_bones(take: Take, rows: list[MappedJoint]) -> tuple[Take, MappingReport]:
    """Without joints that lie on their parents: no bone leads to them."""
    parents = take.parents or hung_as_bodies_are(take.names)
    out = without_length(take.names, parents, take.positions_m)
    if not out:
        return replace(take, parents=parents), MappingReport(tuple(rows))
    at = [i for i in range(len(take.names)) if i not in out]
    gone = {take.names[i] for i in out}
    rows = [replace(r, became="left out", why="no bone to it") if r.joint in gone else r for r in rows]
    slim = replace(
        take,
        names=tuple(take.names[i] for i in at),
        parents=hung_as_in_the_file(parents, at),
        positions_m=take.positions_m[:, at],
    )
    return slim, MappingReport(tuple(rows))
