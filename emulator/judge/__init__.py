"""Judges: pure functions that say how far drawn motions are from real ones. A table of contents; importing is light.

``distances`` feeds ``energy_u``, ``disco``, ``mds`` and ``novelty``; ``roughness`` looks at postures; ``compare`` asks
all of them; the controls must be seen to fail. ``Quantization`` labels postures for ``variability`` and
``transition_matrices``; ``two_level`` tries schemes on a known law; ``plausibility`` looks at bodies.
``held_out_table`` makes one table of it all on held-out repetitions, ``paper`` the tables of the paper.
"""

from emulator.judge.canonical_postures import (
    Quantization,
    Variability,
    sampled_postures,
    transition_distance,
    transition_matrices,
    uniform_transitions,
    variability,
)
from emulator.judge.comparison import Comparison, compare, jittered_resampler, resampler
from emulator.judge.joint_limits import (
    LIMITS_DEG,
    Plausibility,
    joint_angles_deg,
    plausibility,
    plausibility_rows,
    standing_deg,
)
from emulator.judge.likelihood import LikelihoodComparison, TwoLevelRow, compare_likelihood, qq_points, two_level
from emulator.judge.posture_tests import (
    Disco,
    disco,
    joint_reconstruction,
    novelty,
    reconstruction_error,
    roughness,
    temporal_roughness,
)
from emulator.judge.sequence_distances import (
    Mds,
    distances,
    energy_of_size,
    energy_stratified,
    energy_u,
    energy_v,
    mds,
    mds_of_two,
    pooled,
)

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
