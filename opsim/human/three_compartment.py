"""3CC-r: muscle rests, works or is fatigued, joint by joint, by how much of its strength is asked of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import log1p
from typing import TYPE_CHECKING, Any, ClassVar

from opsim.human.muscles import MUSCLES
from opsim.human.parameter import Checked, parameter

if TYPE_CHECKING:
    import numpy as np

JOINTS: dict[str, str] = {
    "left_shoulder": "shoulder",
    "right_shoulder": "shoulder",
    "left_elbow": "elbow",
    "right_elbow": "elbow",
    "back": "trunk",
    "hips": "general",
    "knees": "knee",
}
"""The joints whose muscles are followed, in the order of every array of them, and whose rates each takes."""
LONGEST_S = 1e6


class Compartments:
    """shares : (J, 5) of each joint's muscles at work and fatigued, then their rates; worst : the most fatigued

    Written to as time passes, a run long: copying it would cost a tenth of a run.
    """

    __slots__ = ("shares", "worst")

    def __init__(self, shares: np.ndarray, worst: float = 0.0):
        self.shares, self.worst = shares, worst


@dataclass(frozen=True, slots=True)
class ThreeCompartment(Checked):
    """The three-compartment controller with faster recovery at rest, in closed form between changes of the load.

    Source of the equations: Xia & Frey Law 2008, J. Biomech. 41, 3046-3052, as printed in the appendix of Frey-Law,
    Looft & Heitsman 2012; faster recovery at rest (a load of 0): Looft, Herkert & Frey-Law 2018. Rates:
    ``opsim.human.muscles``. That the joint that is worst off slows the whole person, by slows at full fatigue and in
    proportion of log time before, is an assumption: the papers say how much force is left, not how fast people work.
    """

    does: ClassVar[str] = "muscles tire by the load on each joint; the most tired joint slows the person"
    source: ClassVar[str] = (
        "Xia, T. & Frey Law, L. A. (2008). J. Biomech. 41, 3046-3052; Frey-Law, L. A., Looft, J. M. & Heitsman, J. "
        "(2012). J. Biomech. 45, 1803-1808; Looft, J. M., Herkert, N. & Frey-Law, L. (2018). J. Biomech. 77, 16-25"
    )
    slows: float = parameter(
        0.2, "how much longer work takes where a joint's muscles are wholly fatigued", unit="share", neutral=0.0,
        at_least=0.0, at_most=10.0,
    )  # fmt: skip

    rests_below: float = parameter(
        0.05, "load under which muscles recover as at rest", unit="share", at_least=0.0, at_most=1.0
    )

    needs_burden: ClassVar[bool] = True

    def fresh(self) -> Compartments:
        """A rested person."""
        import numpy as np

        rates = ((m.tires_per_s, m.recovers_per_s, m.at_rest) for m in (MUSCLES[name] for name in JOINTS.values()))
        return Compartments(np.array([(0.0, 0.0, *of_joint) for of_joint in rates]))

    def felt(self, course: np.ndarray | None) -> np.ndarray | None:
        """A course of loads (P, J) as muscles take it: what is below ``rests_below`` is nothing; at 0 it is left alone.

        An assumption: the papers' rests are of no load at all, and no arm ever hangs quite without one.
        """
        import numpy as np

        return None if course is None else np.where(course < self.rests_below, 0.0, course)

    def passed(
        self, state: Compartments, course: np.ndarray | None, first: float, last: float, work_s: float, rest_s: float
    ) -> Compartments:
        """The same state after a piece of work, from share ``first`` to ``last`` of a performance, of some seconds, and
        a rest then.

        course : (P, J) loads on the joints, 0..1 of their strength, in even parts of the whole performance; None:
                 nothing is asked of any
        """
        if course is None:
            return self.rested(state, work_s + rest_s)
        state.worst = _kernel().spend(state.shares, course, first, last, work_s, rest_s)
        return state

    def rested(self, state: Compartments, seconds: float) -> Compartments:
        """The same state after a rest of some seconds."""
        state.worst = _kernel().rest(state.shares, seconds)
        return state

    def level(self, state: Compartments) -> float:
        """The fatigued share of the joint that is worst off."""
        return state.worst

    def by_joint(self, state: Compartments) -> dict[str, float]:
        """The fatigued share of each joint."""
        return dict(zip(JOINTS, state.shares[:, 1].tolist()))

    def shift(self, level: float) -> float:
        """Of log time: work takes exp(shift) times as long."""
        return log1p(self.slows) * level

    def rest_to_s(self, state: Compartments, level: float) -> float:
        """Seconds of rest after which no joint is above a level, above 0; to 1 ms, from above."""
        return float(_kernel().rest_to_s(state.shares, state.shares.copy(), level))


def endurance_s(region: str, share: float) -> float:
    """Seconds for which fresh muscles hold a share of strength, below 1: until none that rests is left to help.

    inf where they hold it for ever: below 1 / (1 + F / R).
    """
    from opsim.ergonomics.kernels.compartments import exhausted_s

    muscle = MUSCLES[region]
    found = float(exhausted_s(share, muscle.tires_per_s, muscle.recovers_per_s, LONGEST_S))
    return found if found >= 0 else float("inf")


@cache
def _kernel() -> Any:
    """The compiled loops, which nobody loads who does not need them."""
    from opsim.ergonomics.kernels import compartments

    return compartments
