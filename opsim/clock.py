"""Time on a grid of 2^-20 s: sums are exact, ties are real, and pieces end when they should.

The grid holds up to 2^33 s (272 years) in a float without loss.
"""

TICKS_PER_S = 2**20
STEP_S = 1 / TICKS_PER_S
LONGEST_S = 2.0**33


def on_grid(delay_s: float) -> float:
    """A delay rounded once to a multiple of 2^-20 s, at least one of them."""
    return max(1, round(delay_s * TICKS_PER_S)) / TICKS_PER_S


def ticks(times_s):
    """Times on the grid as whole ticks (int64), for sums that must be exact."""
    import numpy as np

    return np.rint(np.asarray(times_s) * TICKS_PER_S).astype(np.int64)


DAYS = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")
LONG_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
DAY_S, WEEK_S = 86_400.0, 604_800.0


def on_the_clock(time_s: float) -> str:
    """Seconds from midnight of any day as a time of the day: "06:00", with seconds only where there are some."""
    minutes, seconds = divmod(round(time_s % DAY_S), 60)
    text = f"{minutes // 60 % 24:02d}:{minutes % 60:02d}"
    return f"{text}:{seconds:02d}" if seconds else text
