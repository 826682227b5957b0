"""Judges: pure functions that say how far drawn motions are from real ones. A table of contents; importing is light.

``distances`` feeds ``energy_u``, ``disco`` and ``novelty``; ``roughness`` looks at postures; ``compare`` asks all of
them; the controls must be seen to fail.
"""

from emulator.judge.compare import Comparison, compare
from emulator.judge.controls import jittered_resampler, resampler
from emulator.judge.disco import Disco, disco
from emulator.judge.distance import distances
from emulator.judge.energy import energy_stratified, energy_u, energy_v, pooled
from emulator.judge.novelty import novelty
from emulator.judge.reconstruction import joint_reconstruction, reconstruction_error
from emulator.judge.roughness import roughness, temporal_roughness

__all__ = [
    "Comparison",
    "Disco",
    "compare",
    "disco",
    "distances",
    "energy_stratified",
    "energy_u",
    "energy_v",
    "jittered_resampler",
    "joint_reconstruction",
    "novelty",
    "pooled",
    "reconstruction_error",
    "resampler",
    "roughness",
    "temporal_roughness",
]
