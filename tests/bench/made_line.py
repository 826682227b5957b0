"""A made model for benchmarks of whole commands: some 50 ms of one core a replication, with its files."""

LINE = """
opsim: 1
name: Three stations
run: {{horizon: {horizon}, warm_up: 10 min, replications: 200, seed: 7}}
layout: {{distance: rectilinear, places: {{in: [0 m, 0 m], mid: [4 m, 0 m], out: [8 m, 0 m]}}}}
tasks:
  cut:  {{dist: lognormal, mean: 20 s, cv: 0.25}}
  sew:  {{dist: lognormal, mean: 22 s, cv: 0.25, between_share: 0.5}}
  pack: {{dist: lognormal, mean: 20 s, cv: 0.25}}
stations:
  cutting: {{at: in, tasks: [cut], buffer: 4}}
  sewing:  {{at: mid, tasks: [sew], buffer: 4}}
  packing: {{at: out, tasks: [pack], buffer: 4}}
products: {{shirt: {{route: [cutting, sewing, packing]}}}}
release: {{kind: poisson, every: 26 s}}
workers:
  ana: {{walk: 1.2 m/s, skills: {{cutting: 1.0, sewing: 1.0}}}}
  ben: {{walk: 1.2 m/s, skills: {{sewing: 1.0, packing: 1.0}}}}
  eva: {{walk: 1.2 m/s, skills: {{packing: 1.0, cutting: 1.0}}}}
outputs: [throughput_per_h, time_in_system_s, worker_states]
"""


def line(folder, horizon="6 h"):
    """The file of the model, written."""
    path = folder / "line.yaml"
    path.write_text(LINE.format(horizon=horizon))
    return path
