"""Rows of a summary about exposure, made by hand."""


def row(kpi, subject, part, mean, half=0.5):
    return {
        "kpi": kpi, "subject": subject, "part": part, "unit": "min/h", "mean": mean, "half_width": half,
        "low": mean - half, "high": mean + half, "n": 5, "headline": True,
    }  # fmt: skip


def levels(subject, seven, five, most, half=0.5):
    """Of a worker, or of all."""
    return [
        row("rula_from_7_min_per_h", subject, "", seven, half),
        row("rula_from_5_min_per_h", subject, "", five, half),
        row("rula_from_5_min_per_h", subject, "at_most", most, half),
    ]


def by(kpi, subject, seven, five, most, half=0.5):
    parts = (("rula_from_7", seven), ("rula_from_5", five), ("rula_from_5_at_most", most))
    return [row(kpi, subject, part, value, half) for part, value in parts]


ROWS = [
    *levels("", 4.0, 20.0, 24.0),
    *levels("ana", 6.0, 25.0, 30.0),
    *levels("ben", 2.0, 15.0, 18.0),
    *by("exposure_by_task", "pick", 4.0, 16.0, 17.0),
    *by("exposure_by_task", "pack", 0.0, 4.0, 7.0),
    *by("exposure_by_station", "shelf", 4.0, 16.0, 17.0),
    *by("exposure_by_station", "none", 0.0, 0.0, 0.0),
    *by("exposure_by_hour", "06:00", 5.0, 22.0, 25.0),
    *by("exposure_by_hour", "07:00", 3.0, 18.0, 23.0),
    row("exposure_by_region", "trunk", "rula_from_5", 12.0),
    row("exposure_by_region", "trunk", "rula_from_7", 3.0),
    row("exposure_by_region", "load", "rula_from_5", 8.0),
    row("exposure_by_region", "load", "rula_from_7", 1.0),
    row("exposure_by_region", "legs", "rula_from_5", 0.0),
    row("exposure_by_region", "legs", "rula_from_7", 0.0),
]
