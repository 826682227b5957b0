"""The three compartments as the papers print them, by a stiff-enough integrator: the twin of the closed form."""

import numpy as np
from scipy.integrate import solve_ivp

L = 10.0


def controller(active, resting, load):
    """Frey-Law, Looft & Heitsman 2012, appendix: the flow from rest into work."""
    if active < load:
        return L * (load - active) if resting > load - active else L * resting
    return L * (load - active)


def naive_held(active, fatigued, load, tires, recovers, seconds):
    """(active, fatigued, resting) after a constant load, all three integrated, so that their sum can be looked at."""

    def flow(_t, y):
        resting, active, fatigued = y
        c = controller(active, resting, load)
        return [-c + recovers * fatigued, c - tires * active, tires * active - recovers * fatigued]

    out = solve_ivp(
        flow, (0.0, seconds), [1.0 - active - fatigued, active, fatigued],
        method="DOP853", rtol=1e-12, atol=1e-14, max_step=0.5,
    )  # fmt: skip
    resting, active, fatigued = out.y[:, -1]
    return active, fatigued, resting


def naive_course(stretches, tires, recovers, at_rest):
    """From fresh, through (load, seconds) one after the other."""
    active = fatigued = 0.0
    for load, seconds in stretches:
        pace = recovers * at_rest if load == 0 else recovers
        active, fatigued, _ = naive_held(active, fatigued, load, tires, pace, seconds)
    return np.array([active, fatigued])
