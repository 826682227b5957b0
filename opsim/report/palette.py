"""The colours of states: Okabe and Ito's, told apart with any colour vision, with the word beside them everywhere."""

STATES = {
    "work": ("#0072B2", "#ffffff"),
    "walk": ("#56B4E9", "#111111"),
    "setup": ("#009E73", "#ffffff"),
    "transport": ("#7BC8A4", "#111111"),
    "held": ("#CC79A7", "#111111"),
    "team": ("#B58BB0", "#111111"),
    "parts": ("#C9B037", "#111111"),
    "tool": ("#A8894A", "#111111"),
    "place": ("#E58A5A", "#111111"),
    "pickup": ("#9CCBB3", "#111111"),
    "blocked": ("#D55E00", "#ffffff"),
    "waiting": ("#E69F00", "#111111"),
    "queue": ("#F0E442", "#111111"),
    "down": ("#7a1f1f", "#ffffff"),
    "repair": ("#a05a5a", "#ffffff"),
    "break": ("#b9a7d6", "#111111"),
    "absent": ("#8d8d8d", "#ffffff"),
    "off": ("#bcbcbc", "#111111"),
    "wait": ("#dde1e6", "#111111"),
    "starved": ("#eceff2", "#111111"),
    "loaded": ("#1F7FB8", "#ffffff"),
    "handling": ("#2BAA7E", "#ffffff"),
    "empty": ("#8AC9EC", "#111111"),
    "free": ("#E4E8EC", "#111111"),
    "below_20": ("#8CC5E3", "#111111"),
    "from_20_to_60": ("#F0A830", "#111111"),
    "beyond_60": ("#B0410B", "#ffffff"),
    "walking_below_20": ("#A6DCC3", "#111111"),
    "walking_from_20": ("#CDA53B", "#111111"),
    "unmeasured": ("#9AA1A9", "#111111"),
    "walking_unmeasured": ("#BFC5CC", "#111111"),
    "waits": ("#f1f3f5", "#111111"),
    "not_at_work": ("#edf0f3", "#111111"),
}
OTHER = ("#999999", "#111111")

WORDS = {
    "wait": "idle",
    "waiting": "job there, no worker",
    "starved": "no job",
    "blocked": "blocked by the next buffer",
    "held": "held by a blocked job",
    "setup": "set-up",
    "team": "waiting for the rest of the team",
    "parts": "waiting for parts",
    "tool": "waiting for a tool",
    "place": "waiting for a place kept downstream",
    "pickup": "waiting for a transporter",
    "down": "down, nobody repairs yet",
    "repair": "being repaired or maintained",
    "loaded": "driving with jobs",
    "handling": "loading or unloading",
    "empty": "driving empty",
    "free": "standing free",
    "below_20": "trunk flexed less than 20°",
    "from_20_to_60": "20° to 60°",
    "beyond_60": "60° or more",
    "unmeasured": "at work, posture not known",
    "walking_below_20": "walking, trunk flexed less than 20°",
    "walking_from_20": "walking, 20° or more",
    "walking_unmeasured": "walking, posture not known",
    "waits": "waiting, not measured",
    "not_at_work": "walking or waiting, not measured",
}

ACCENT, INK, MUTED, GRID = "#0072B2", "#22262b", "#5c6570", "#e3e6ea"


def in_order(parts) -> list[str]:
    """States in the order of the palette, unknown ones last."""
    order = list(STATES)
    return sorted(set(parts), key=lambda part: (order.index(part) if part in order else len(order), part))
