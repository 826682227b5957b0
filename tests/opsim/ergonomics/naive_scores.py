"""The naive twin of the scores' kernel: all that what is unknown may be, through rula(), reba() and owas()."""

from __future__ import annotations

from itertools import product
from math import acos, cos, degrees, isnan, radians

from opsim.ergonomics.angles import AT
from opsim.ergonomics.scores.owas import owas
from opsim.ergonomics.scores.reba import reba
from opsim.ergonomics.scores.rula import rula

BANDS = {"trunk": (0.0, 10.0, 40.0, 100.0), "neck": (0.0, 15.0, 30.0, -30.0), "arm": (0.0, 30.0, 60.0, 120.0)}
BANDS |= {"elbow": (80.0, 0.0), "wrist": (0.0, 10.0, 30.0), "knee": (0.0, 45.0, 90.0), "above": (-1.0, 1.0)}
"""An angle of each band: what an angle that nobody knows may be."""


class Posture:
    """One row of measures, asked by name; each answer is everything that it may be."""

    def __init__(self, row, options):
        self.row, self.options, self.t = row, options, options.thresholds

    def one(self, name):
        return float(self.row[AT[name]])

    def may_be(self, name, band):
        value = self.one(name)
        return BANDS[band] if isnan(value) else (value,)

    def flag(self, name, *edges):
        value = self.one(name)
        return (False, True) if isnan(value) else tuple(sorted({abs(value) >= edge for edge in edges}))

    def twisted(self):
        return self.flag("trunk_twist", *((5.0, 20.0) if self.t.spread else (self.t.twist,)))

    def bent(self, name):
        return self.flag(name, *((5.0, 20.0) if self.t.spread else (self.t.side,)))

    def arm(self, side):
        """The angle that is scored: far out to the side the elevation of the arm, in place of its flexion."""
        flexion, abduction = self.one(f"{side}_arm_flexion"), self.one(f"{side}_arm_abduction")
        if abs(abduction) <= self.t.arm_sideways:
            return self.may_be(f"{side}_arm_flexion", "arm")
        flexions = (0.0, 120.0) if isnan(flexion) else (flexion,)
        beyond = 0.5 * (self.t.arm_sideways + 90.0) if isnan(abduction) else abduction
        raised = [degrees(acos(cos(radians(beyond)) * cos(radians(one)))) for one in flexions]
        return raised + list(self.may_be(f"{side}_arm_flexion", "arm")) if isnan(abduction) else raised

    def out(self, side):
        """Whether the forearm works across the midline or out: where the upper arm is not abducted, by turning it."""
        found = set()
        for abducted in self.flag(f"{side}_arm_abduction", self.t.abducted):
            across = [self.one(f"{side}_across_m") >= self.t.across_m]
            outside = [self.one(f"{side}_outside_m") >= self.t.outside_m]
            across = [False, True] if isnan(self.one(f"{side}_across_m")) else across
            outside = [False, True] if isnan(self.one(f"{side}_outside_m")) else outside
            found |= {a or (o and not abducted) for a in across for o in outside}
        return tuple(found)

    def knees(self):
        return tuple(product(self.may_be("left_knee", "knee"), self.may_be("right_knee", "knee")))

    def sits(self, knees, bounds):
        """Whether he may sit, and may not: with both knees straight nobody does who is not said to."""
        edge = 180.0 - self.t.owas_knee
        bent = any(knee > edge for knee in knees)
        return tuple(sit for sit in each(bounds.sitting) if not sit or bent or bounds.sitting == (1, 1))


def each(pair):
    return tuple(range(pair[0], pair[1] + 1))


def worse_arm(shared, own, score):
    """Low and high of the worse arm: what is shared is the same for both, what is an arm's own is not."""
    lows, highs = [], []
    for common in shared:
        sides = [[score(common, arm) for arm in arms] for arms in own]
        lows.append(max(min(side) for side in sides))
        highs.append(max(max(side) for side in sides))
    return min(lows), max(highs)


def naive_rula(posture, said, repeated, static):
    t, o = posture.t, posture.options
    force = {0: (0.0, "static"), 1: (5.0, "intermittent"), 2: (5.0, "static"), 3: (20.0, "static")}
    forces = said.rula_force if o.rula_force == "paper" else said.rula_force_worksheet
    sits = {sit for knees in posture.knees() for sit in posture.sits(knees, said)}
    shared = list(product(posture.may_be("trunk_flexion", "trunk"), posture.twisted(), posture.bent("trunk_side"),
                          posture.may_be("neck_flexion", "neck"), posture.bent("neck_side"), sits,
                          each(said.one_legged), each(said.wrist_twist), each(forces),
                          each(said.supported)))  # fmt: skip
    own = [list(product(posture.arm(side), posture.flag(f"{side}_arm_abduction", t.abducted), posture.out(side),
                        posture.may_be(f"{side}_elbow", "elbow"), posture.may_be(f"{side}_wrist", "wrist")))
           for side in ("left", "right")]  # fmt: skip

    def score(common, arm):
        trunk, twisted, bent, neck, neck_bent, sits, one_legged, twist, pushed, supported = common
        flexion, abducted, out, elbow, wrist = arm
        kg, pattern = force[pushed]
        return rula(
            upper_arm_flex=flexion, upper_arm_abducted=abducted, arm_supported=supported, elbow_flex=elbow,
            across_midline_or_out=out, wrist_flex=wrist, wrist_twist=twist, neck_flex=neck, neck_side_bent=neck_bent,
            trunk_flex=trunk, trunk_twisted=twisted, trunk_side_bent=bent,
            seated_supported=bool(sits) and trunk <= t.trunk_upright, legs_supported=not one_legged,
            muscle_use=repeated or static, force_kg=kg, force_pattern=pattern, force_rule=o.rula_force,
            table_a=o.rula_table_a, thresholds=t,
        ).grand  # fmt: skip

    return worse_arm(shared, own, score)


def naive_reba(posture, said, repeated, static):
    t = posture.t
    load = {0: (0.0, False), 1: (7.0, False), 2: (20.0, False), 3: (20.0, True)}
    legs = {(max(knees), sit) for knees in posture.knees() for sit in posture.sits(knees, said)}
    shared = list(product(posture.may_be("trunk_flexion", "trunk"), posture.twisted(), posture.bent("trunk_side"),
                          posture.may_be("neck_flexion", "neck"), posture.bent("neck_side"), legs,
                          each(said.one_legged), each(said.reba_load), each(said.coupling), each(said.rapid),
                          each(said.supported)))  # fmt: skip
    own = [list(product(posture.arm(side), posture.flag(f"{side}_arm_abduction", t.abducted),
                        posture.may_be(f"{side}_elbow", "elbow"), posture.may_be(f"{side}_wrist", "wrist")))
           for side in ("left", "right")]  # fmt: skip

    def score(common, arm):
        trunk, twisted, bent, neck, neck_bent, (knee, sits), one_legged, held, coupling, rapid, supported = common
        flexion, abducted, elbow, wrist = arm
        kg, shock = load[held]
        return reba(
            neck_flex=neck, neck_side_bent=neck_bent, trunk_flex=trunk, trunk_twisted=twisted, trunk_side_bent=bent,
            knee_flex=knee, bilateral=not one_legged, sitting=bool(sits) or said.walking, upper_arm_flex=flexion,
            upper_arm_abducted_or_rotated=abducted, arm_supported=supported, elbow_flex=elbow, wrist_flex=wrist,
            load_kg=kg, shock=shock, coupling=coupling, activity=int(repeated) + int(static) + rapid, thresholds=t,
        ).reba  # fmt: skip

    return worse_arm(shared, own, score)


def naive_owas(posture, said):
    t, found = posture.t, set()
    bents = posture.flag("trunk_flexion", t.owas_back)
    twists = {
        a or b for a in posture.flag("trunk_twist", t.owas_twist) for b in posture.flag("trunk_side", t.owas_twist)
    }
    ups = {(a >= 0) + (b >= 0) for a in posture.may_be("left_elbow_above_m", "above")
           for b in posture.may_be("right_elbow_above_m", "above")}  # fmt: skip
    legs = {digit for knees in posture.knees() for digit in naive_legs(posture, knees, said)}
    for bent, twisted, up, leg, load in product(bents, twists, ups, legs, each(said.owas_load)):
        found.add(owas(f"{1 + bent + 2 * twisted}{1 + up}{leg}{load}", posture.options.owas_disputed).category)
    return min(found), max(found)


def naive_legs(posture, knees, said):
    if said.walking:
        return {7}
    bent = [knee > 180.0 - posture.t.owas_knee for knee in knees]
    found = set()
    for sits, one_legged in product(posture.sits(knees, said), each(said.one_legged)):
        standing = {(5 if one else 4) if leg else (3 if one else 2) for leg in bent for one in [one_legged]}
        found |= {1} if sits else standing
    return found


def naive_scores(row, bounds, options, repeated, static, carrying):
    """((low, high) of RULA, of REBA, of OWAS)."""
    posture, said = Posture(row, options), bounds if carrying else bounds.empty_handed()
    return (
        naive_rula(posture, said, repeated, static),
        naive_reba(posture, said, repeated, static),
        naive_owas(posture, said),
    )
