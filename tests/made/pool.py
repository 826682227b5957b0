"""Three people for two stations, heavy and light: a floor for rules that look at how exposed everybody was."""

POOL = """
opsim: 1
name: pool
run: {horizon: 2 h, seed: 8}
layout: {places: {here: [0 m, 0 m]}}
tasks: {heavy: {dist: lognormal, mean: 30 s, cv: 0.4}, light: {dist: lognormal, mean: 20 s, cv: 0.4}}
stations:
  a: {at: here, tasks: [heavy], buffer: 5}
  b: {at: here, tasks: [light], buffer: 5}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 40 s}
workers:
  ana: {skills: {a: 1, b: 1}}
  ben: {skills: {a: 1, b: 1}}
  cem: {skills: {a: 1, b: 1}}
allocation: {rule: least_exposed}
"""
