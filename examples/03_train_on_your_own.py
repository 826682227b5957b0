"""Train an emulator and use it in a scenario: here on made movements; with your own, read_motions("recordings.npz")."""

import tempfile
from pathlib import Path

from emulator import MotionEmulator, synthetic
from opsim import compile_plan, figures, read_scenarios, run_plan

SCENARIO = """
opsim: 1
name: Own movements
run: {horizon: 1 h, seed: 4}
libraries: {mine: own.npz}
layout: {places: {bench: [0 m, 0 m]}}
tasks: {assemble: {emulator: mine/fasten, repeat: 3}}
stations: {bench: {at: bench, tasks: [assemble], buffer: 1}}
products: {unit: {route: [bench]}}
release: {kind: saturated}
workers: {ana: {skills: {bench: 1.0}}}
"""

motions, truth = synthetic.make("fasten", n_workers=5, n_repetitions=6, seed=3)
model = MotionEmulator.fit(motions)
print(f"{model.task}: {model.report.n_sequences} repetitions of {model.report.n_workers} made-up people")

with tempfile.TemporaryDirectory() as folder:
    model.save(Path(folder) / "own.npz")
    (Path(folder) / "own.yaml").write_text(SCENARIO)
    plan = compile_plan(read_scenarios(Path(folder) / "own.yaml")["base"])
    found = {(f.kpi, f.subject): f.value for f in figures(run_plan(plan), plan)}

print(f"{found['throughput_per_h', '']:.0f} units an hour, {found['cycle_time_s', 'bench']:.1f} s each")
