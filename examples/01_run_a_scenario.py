"""Run a shipped scenario from Python and look at its rows."""

import tempfile
from pathlib import Path

from opsim import compile_plan, figures, read_scenarios, run_plan, run_scenario

variants = read_scenarios("repack_cell.yaml")  # the name of a shipped scenario, or a path
print("variants:", ", ".join(variants))

plan = compile_plan(variants["base"])
log = run_plan(plan, replication=0)
print("rows of replication 0:", len(log))
for figure in figures(log, plan):
    if figure.kpi == "throughput_per_h":
        print(f"{figure.kpi} {figure.subject or 'all'}: {figure.value:.1f}")

with tempfile.TemporaryDirectory() as folder:
    result = run_scenario(variants["near"], folder=Path(folder), replications=5)
    row = next(row for row in result.summary["kpis"] if row["kpi"] == "time_in_system_s" and not row["subject"])
    print(f"rack near: a job stays {row['mean']:.0f} s +- {row['half_width']:.0f} s in {row['n']} replications")
