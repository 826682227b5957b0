"""A moving line of three stations and an empty stretch: 6 m are passed in 60 s."""

LINE = """
opsim: 1
name: moving
run: {horizon: HORIZON s, seed: SEED}
layout: {places: {a: [0 m, 0 m], b: [6 m, 0 m], c: [15 m, 0 m], d: [21 m, 0 m]}}
tasks:
  t1: {dist: lognormal, mean: 42 s, cv: 0.3}
  t2: {dist: lognormal, mean: 66 s, cv: 0.35}
  t3: {dist: lognormal, mean: 50 s, cv: 0.25}
stations: {s1: {at: a, tasks: [t1]}, s2: {at: b, tasks: [t2]}, gap: {at: c, tasks: []}, s3: {at: d, tasks: [t3]}}
lines:
  trim: {kind: moving, stations: [s1, s2, gap, s3], takt: 60 s, length: 6 m, lengths: {s2: 9 m, gap: 2.5 m},
         speed: 0.1 m/s, upstream: UP m, drift: DRIFT m, unfinished: UNFINISHED}
products: {car: {route: [s1, s2, gap, s3]}}
release: {kind: saturated}
workers:
  w1: {walk: 1.1 m/s, skills: {s1: 1.0}}
  w2: {walk: 1.1 m/s, skills: {s2: 1.1}}
  w3: {walk: 1.1 m/s, skills: {s3: 1.0}}
"""


def moving_line(upstream, drift, unfinished, seed=2, horizon=2400):
    """Its text. upstream, drift : m, beyond a stretch; unfinished : ``stop`` or ``send_on``"""
    text = LINE.replace("SEED", str(seed)).replace("UP m", f"{upstream} m").replace("DRIFT", str(drift))
    return text.replace("UNFINISHED", unfinished).replace("HORIZON", str(horizon))
