"""What a score asks for, and neither a skeleton shows nor a scenario says: it counts as absent."""

from __future__ import annotations

NOT_SEEN = (
    "RULA, REBA: the neck is taken as not twisted: a head is one joint, which does not say where somebody looks",
    "RULA, REBA: the wrist is taken as not bent towards thumb or little finger: a hand is one line",
    "RULA, REBA: the shoulder is taken as not raised",
    "REBA: the upper arm is taken as not rotated, and not as helped by gravity",
    "REBA: the wrist is taken as not twisted (RULA's twist of the forearm is `handling.forearm`)",
    "RULA: a trunk bent backward counts as one bent forward by as much: the paper draws none",
    "RULA: whoever sits is well supported where his trunk is upright or leans back",
    "RULA, REBA: where sitting is not said, whoever has both knees straight does not sit",
    "REBA: the knees of somebody who walks or sits do not count",
    "OWAS: nobody kneels: bodies on their knees are taken as squatting, on one knee or both as their legs are bent",
    "OWAS: a body on both feet with one knee bent, which the method has no code for, is taken as both ways",
)
"""Sentences for the assumption sheet."""
