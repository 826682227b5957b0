"""What scores ask for and nobody sees or says, which counts as absent; and how the methods were read."""

from __future__ import annotations

NOT_SEEN = (
    "RULA, REBA: the neck is taken as not twisted: a head is one joint, which does not say where somebody looks",
    "RULA, REBA: how far a wrist is bent is the angle between forearm and hand in any direction: bent towards thumb or "
    "little finger alone, by more than 15 degrees, it scores more by RULA than by the paper (3, not 2); the point that "
    "the papers add for being bent so is never added",
    "RULA, REBA: the shoulder is taken as not raised",
    "REBA: the upper arm is taken as not rotated, and not as helped by gravity",
    "REBA: the wrist is taken as not twisted (how far the forearm is, which RULA asks for, can be said)",
    "OWAS: nobody kneels: bodies on their knees are taken as squatting, on one knee or both as their legs are bent",
)
"""Sentences for the assumption sheet: what no skeleton shows."""
RULES = (
    "RULA: a trunk bent backward counts as one bent forward by as much: the paper draws none",
    "RULA: whoever sits is well supported where his trunk is upright or leans back",
    "RULA, REBA: where sitting is not said, whoever has both knees straight does not sit",
    "REBA: the knees of somebody who walks or sits do not count",
    "OWAS: a body on both feet with one knee bent, which the method has no code for, is taken as both ways",
)
"""Sentences for the assumption sheet: how the methods were read where they leave it open."""
