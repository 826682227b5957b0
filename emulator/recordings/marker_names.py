"""Names of skin markers in other sets, as Plug-in Gait calls the markers at these places.

Sources: the marker sets of Qualisys (Animation, Sports) and OptiTrack Motive (Baseline), which name places alike.
"""

from __future__ import annotations

import re

from emulator.recordings.joint_words import bare_name

_SIDED = {
    "SHOULDERTOP": "SHO", "ELBOWOUT": "ELB", "ELBOWIN": "MELB", "WRISTOUT": "WRA", "WRISTIN": "WRB", "HANDOUT": "FIN",
    "KNEEOUT": "KNE", "KNEEIN": "MKNE", "ANKLEOUT": "ANK", "ANKLEIN": "MMA", "TOETIP": "TOE", "HEELBACK": "HEE",
}  # fmt: skip
_OTHER = {
    "WAISTLFRONT": "LASI", "WAISTRFRONT": "RASI", "WAISTLBACK": "LPSI", "WAISTRBACK": "RPSI", "SPINETOP": "C7",
    "BACKTOP": "C7", "LASIS": "LASI", "RASIS": "RASI", "LPSIS": "LPSI", "RPSIS": "RPSI", "SACRUM": "SACR",
}  # fmt: skip


def marker_name(name: str) -> str:
    """A marker's name in capitals and without its person, by Plug-in Gait where another set has it there."""
    plain = re.sub(r"[^A-Z0-9]", "", bare_name(name).upper())
    if plain in _OTHER:
        return _OTHER[plain]
    return plain[0] + _SIDED[plain[1:]] if plain[:1] in ("L", "R") and plain[1:] in _SIDED else plain
