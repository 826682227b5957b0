"""Made performances to look at, for tests of the animated page and of videos."""

import numpy as np

from opsim.report.plot.animation import Video
from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from opsim.report.sections.motions import Card
from tests.opsim.report.test_strips import NAMES, STANDING, Skeleton

SKELETON = Skeleton()


def cards(n, seconds=1.0, travel_m=0.0):
    """n recorded and n emulated ones in turn: each lifts its right hand, every one a bit higher."""
    return [_card(k, round(seconds * RATE_HZ) + 1, travel_m) for k in range(2 * n)]


def _card(k, n_frames, travel_m):
    share = np.linspace(0, 1, n_frames)
    positions = np.tile(STANDING, (n_frames, 1, 1))
    positions[:, :, 0] += travel_m * share[:, None]
    positions[:, NAMES.index("right_wrist"), 2] += (0.4 + 0.02 * k) * np.sin(np.pi * share)
    return Card(positions, k % 2 == 0, f"person {k}")


def video(n=2, seconds=0.5, travel_m=0.0, task="reach", notes=(("Licence", "none"),)):
    """A mean and n simulated ones, each 0.1 s longer than the one before."""
    shown = [_card(k, round((seconds + 0.1 * k) * RATE_HZ) + 1, travel_m) for k in range(n + 1)]
    return Video(task, f"The mean beside {n}.", shown[0], tuple(shown[1:]), SKELETON, notes)
