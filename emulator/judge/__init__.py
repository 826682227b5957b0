"""Judges: pure functions that say how far drawn motions are from real ones. A table of contents; importing is light.

``distances`` feeds ``energy_u``, ``disco``, ``mds`` and ``novelty``; ``roughness`` looks at postures; ``compare`` asks
all of them; the controls must be seen to fail. ``Quantization`` labels postures for ``variability`` and
``transition_matrices``; ``two_level`` tries schemes on a known law; ``plausibility`` looks at bodies.
``held_out_table`` makes one table of it all on held-out repetitions, ``paper`` the tables of the paper.
"""

from emulator.judge.compare import Comparison, compare
from emulator.judge.controls import jittered_resampler, resampler
from emulator.judge.disco import Disco, disco
from emulator.judge.distance import distances
from emulator.judge.energy import energy_of_size, energy_stratified, energy_u, energy_v, pooled
from emulator.judge.joint_angles import LIMITS_DEG, joint_angles_deg
from emulator.judge.likelihood import LikelihoodComparison, compare_likelihood, qq_points
from emulator.judge.mds import Mds, mds, mds_of_two
from emulator.judge.novelty import novelty
from emulator.judge.plausibility import Plausibility, plausibility, plausibility_rows, standing_deg
from emulator.judge.quantization import Quantization, sampled_postures
from emulator.judge.reconstruction import joint_reconstruction, reconstruction_error
from emulator.judge.roughness import roughness, temporal_roughness
from emulator.judge.transitions import transition_distance, transition_matrices, uniform_transitions
from emulator.judge.two_level import TwoLevelRow, two_level
from emulator.judge.variability import Variability, variability

__all__ = [
    "LIMITS_DEG",
    "Comparison",
    "Disco",
    "LikelihoodComparison",
    "Mds",
    "Plausibility",
    "Quantization",
    "TwoLevelRow",
    "Variability",
    "compare",
    "compare_likelihood",
    "disco",
    "distances",
    "energy_of_size",
    "energy_stratified",
    "energy_u",
    "energy_v",
    "jittered_resampler",
    "joint_angles_deg",
    "joint_reconstruction",
    "mds",
    "mds_of_two",
    "novelty",
    "plausibility",
    "plausibility_rows",
    "pooled",
    "qq_points",
    "reconstruction_error",
    "resampler",
    "roughness",
    "sampled_postures",
    "standing_deg",
    "temporal_roughness",
    "transition_distance",
    "transition_matrices",
    "two_level",
    "uniform_transitions",
    "variability",
]
