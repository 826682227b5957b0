"""Learning and forgetting once more, from the papers' own formulas and by other ways to the same number."""

import math


def exponent(rate):
    """b of T_n = T_1 n^-b."""
    return -math.log(rate) / math.log(2)


def wright(n, rate):
    return math.exp(-exponent(rate) * math.log(n))


def plateau(n, rate, floor):
    time = wright(n, rate)
    return floor if time < floor else time


def de_jong(n, rate, incompressible):
    learned = 1 - wright(n, rate)
    return 1 - (1 - incompressible) * learned


def stanford_b(n, rate, prior):
    return wright(n + prior, rate) / wright(1 + prior, rate)


def hyperbolic(n, prior, half_at):
    def output(x):
        return (x + prior) / (x + prior + half_at)

    return output(1) / output(n)


def dual_phase(n, cognitive_rate, motor_rate, cognitive_share):
    cognitive, motor = cognitive_share, 1 - cognitive_share
    return cognitive * wright(n, cognitive_rate) + motor * wright(n, motor_rate)


TWINS = {
    "wright": wright,
    "plateau": plateau,
    "de_jong": de_jong,
    "stanford_b": stanford_b,
    "hyperbolic": hyperbolic,
    "dual_phase": dual_phase,
}


def remembered(q, pause, total, first, b):
    """Jaber & Bonney's alpha as they wrote it: the slope f of forgetting, and S, what would have been done by then."""
    worked = first * q ** (1 - b) / (1 - b)
    f = b * (1 - b) * math.log(q) / math.log(1 + total / worked)
    would_be = ((1 - b) / first * pause + q ** (1 - b)) ** (1 / (1 - b))
    return math.exp((1 + f / b) * math.log(q) - f / b * math.log(would_be))
