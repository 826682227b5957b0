"""Paced lines: units that are not done in takt at some station."""

from known_answers.case import Case

_PACED = "paced line, incomplete units"
_KEYS = {"base": "K=1,T=1.0", "ten": "K=10,T=1.0", "ten_slower": "K=10,T=1.1"}
CASES = tuple(
    Case("paced_line", variant, "incomplete_share", (_PACED, "P_incomplete", key), most_half_width=0.02, few=10)
    for variant, key in _KEYS.items()
)
