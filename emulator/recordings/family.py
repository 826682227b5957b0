"""A family of recordings: sets of one kind of task at different places, pooled so that one emulator learns from all.

The place where a joint was at a mark is what tells the members apart; so their marks and skeletons must be the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches

from emulator.motion import MotionSet


def family(task: str, members: Sequence[MotionSet]) -> MotionSet:
    """The recordings of all members as those of one task; a trial is named ``member/trial``.

    People with one name in several members are one person. Marks may stand in any order; the first member's is kept.
    Raises ValueError, with all mistakes, for fewer than two members, one that is there twice, and one with other marks
    or another skeleton than the first.
    """
    wrong = _mistakes(task, members)
    if wrong:
        raise ValueError("\n".join(wrong))
    names = members[0].mark_names
    motions = tuple(
        replace(
            motion, trial=f"{one.task}/{motion.trial}", mark_s=motion.mark_s[[one.mark_names.index(n) for n in names]]
        )
        for one in members
        for motion in one.motions
    )
    source, licence = (
        "; ".join(dict.fromkeys(getattr(one, name) for one in members)) for name in ("source", "licence")
    )
    chosen = list(dict.fromkeys(one.selection for one in members))
    return MotionSet(
        task,
        motions,
        names,
        source,
        licence,
        (_people_said(members), *(f"{one.task}: {note}" for one in members for note in one.notes)),
        chosen[0] if len(chosen) == 1 else "; ".join(f"{one.task}: {one.selection}" for one in members),
    )


def _mistakes(task: str, members: Sequence[MotionSet]) -> list[str]:
    if len(members) < 2:
        return [f"{task}: found a family of {len(members)}, expected two or more sets of recordings"]
    tasks, first = [one.task for one in members], members[0]
    wrong = [
        f"{task}: found {name!r} twice, expected each once" for name in dict.fromkeys(tasks) if tasks.count(name) > 1
    ]
    if not first.mark_names:
        wrong.append(f"{first.task}: found no marks, expected one or more: a place needs a moment")
    for one in members[1:]:
        wrong += _other_marks(one, first) + _other_skeleton(one, first)
    return wrong


def _other_marks(one: MotionSet, first: MotionSet) -> list[str]:
    """A line where the marks are not those of the first member."""
    if set(one.mark_names) == set(first.mark_names):
        return []
    odd = [name for name in one.mark_names if name not in first.mark_names]
    near = [(name, *get_close_matches(name, first.mark_names, n=1)) for name in odd]
    hints = [f"is {pair[0]!r} {first.task}'s {pair[1]!r}?" for pair in near if len(pair) == 2]
    found, expected = (", ".join(names) or "none" for names in (one.mark_names, first.mark_names))
    return [
        "; ".join([f"{one.task}: found the marks {found}, expected those of {first.task}: {expected}", *hints])
        + "; a mark is an array ann_NAME_frame of the file"
    ]


def _other_skeleton(one: MotionSet, first: MotionSet) -> list[str]:
    if one.skeleton == first.skeleton:
        return []
    here, there = one.skeleton.names, first.skeleton.names
    parts = (
        ("no", [name for name in there if name not in here]),
        ("also", [name for name in here if name not in there]),
    )
    said = [f"{word} {', '.join(names[:6])}" for word, names in parts if names]
    found = " and ".join(said) or "the same joints, hung or ordered otherwise"
    return [f"{one.task}: found {found}, expected the skeleton of {first.task}"]


def _people_said(members: Sequence[MotionSet]) -> str:
    """Who is in the family, for people of one name are taken for one person."""
    crews = [set(one.workers) for one in members]
    everybody, shared = set.union(*crews), set.intersection(*crews)
    of = ", ".join(f"{one.task} ({len(one)})" for one in members)
    return f"a family of {of}: {len(everybody)} people, {len(shared)} of them in all"
