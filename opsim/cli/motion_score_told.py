"""What ``opsim motion score`` says beside its figures: what is missing, what is open, what was assumed."""

from __future__ import annotations

from typing import Any

OPEN = {
    "load_kg": "the load (--load)",
    "grip": "the grip (--grip)",
    "force": "how force comes (--force)",
    "forearm": "twist of the forearm (--forearm)",
    "arms_supported": "support of the arms (--arms-supported)",
    "sitting": "whether he sits (--sitting)",
    "legs": "whether both feet carry (--legs)",
    "rapid": "whether posture changes quickly (--rapid)",
}
SETTLED_BY_WALKING = ("arms_supported", "sitting", "legs")
ASSUMED = ("not seen: ", "by rule: ")
"""Beginnings of what holds of every movement."""


def assumptions(found: Any, scored: list[Any], asked: Any) -> list[str]:
    """Sentences: what the skeleton lacks, what nobody said, whence the neck's neutral, what no skeleton shows."""
    from opsim.ergonomics.missing import missing_scores
    from opsim.ergonomics.scores.not_seen import NOT_SEEN, RULES
    from opsim.ergonomics.shift.movement_figures import in_words, unknown_share

    said = [f"missing: {sentence}" for sentence in missing_scores(found.seen_names)]
    said += found.notes
    unknown = unknown_share(scored)
    if unknown > 0:
        share = in_words(unknown, "share")
        said.append(f"missing: nothing is known of the posture for {share} of the time, which no share counts")
    open_words = _open(asked.handling, found.walking)
    if open_words:
        said.append(f"not said, so scores are intervals: {', '.join(open_words)}")
    if asked.handling.load_kg != 0:
        said.append(_loaded(found, scored, asked))
    if not asked.repeated:
        said.append("taken as done less than four times a minute (--repeated)")
    if "head" in found.skeleton.names:
        said.append(f"neutral of the neck: {found.neutral_said}")
    return said + [f"{begins}{each}" for begins, all_of in zip(ASSUMED, (NOT_SEEN, RULES)) for each in all_of]


def _loaded(found: Any, scored: list[Any], asked: Any) -> str:
    """When the hands are full."""
    from opsim.ergonomics.shift.movement_figures import in_words, loaded_share

    load = "something" if asked.handling.load_kg is None else f"{asked.handling.load_kg:g} kg"
    if asked.loaded is None:
        marks = f"; marks: {', '.join(found.mark_names)}" if found.mark_names else ""
        return f"{load} in the hands all the time, as nobody said when (--loaded FROM..TO{marks})"
    share = in_words(loaded_share(scored), "share")
    return f"{load} in the hands {asked.loaded.words}, {share} of the time; empty hands before and after"


def _open(handling: Any, walking: bool) -> list[str]:
    """What is not said and matters: of a load of nothing, neither grip nor force; of walking, nothing that carries."""
    nothing = (*(("grip", "force") if handling.load_kg == 0 else ()), *(SETTLED_BY_WALKING if walking else ()))
    return [words for name, words in OPEN.items() if getattr(handling, name) is None and name not in nothing]
