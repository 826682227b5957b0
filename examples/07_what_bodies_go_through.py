"""What bodies go through: scores over a shift, the worst posture, and what is lost where times and postures part."""

from dataclasses import replace

from opsim import compile_plan, figures, read_scenarios, run_plan
from opsim.ergonomics.shift.worst import worst_frames

HALF_AN_HOUR_S = 2700.0  # after the quarter of an hour that warms up
variants = read_scenarios("low_pallet.yaml")
plan = replace(compile_plan(variants["base"]), horizon_s=HALF_AN_HOUR_S)
log = run_plan(plan)


# %% Figures of bodies are made where one is asked for: each posture of the shift is drawn again, and scored.
def exposure(log, plan):
    asked = ["posture_dose", "exposure_by_task"]
    return {(figure.kpi, figure.subject, figure.part): figure.value for figure in figures(log, plan, asked)}


found = exposure(log, plan)
for task in plan.tasks:
    least, most = (found["exposure_by_task", task.name, f"rula_from_5{end}"] for end in ("", "_at_most"))
    print(f"{task.name}: {least:.1f} to {most:.1f} min an hour at RULA 5 or more")

# %% The worst posture, with the reasons for its score. What nobody said of a task makes the score an interval.
worst = worst_frames(log, plan, 1)[0]
drives = ", ".join(list(worst.why["rula"]["drives"])[:3])
print(f"worst: {worst.worker} at {worst.task}, {worst.clock}, RULA {worst.rula[0]} to {worst.rula[1]}: {drives}")

# %% Draw postures apart from times, and the log is the same to the last bit. What bodies go through is not.
apart = replace(compile_plan(variants["times_apart_from_bodies"]), horizon_s=HALF_AN_HOUR_S)
log_apart = run_plan(apart)
print("rows the same:", all((log[name].tobytes() == log_apart[name].tobytes()) for name in log.columns))
bent, bent_apart = (of["exposure_by_task", "pick_up", "trunk_beyond_60"] for of in (found, exposure(log_apart, apart)))
print(f"picked up with the trunk flexed 60 degrees or more: {bent:.2f} min an hour; apart: {bent_apart:.2f}")

# %% With posture: off nobody looks at postures, and the log is the same.
blind = replace(plan, posture=False)
log_blind = run_plan(blind)
print("rows the same:", all((log[name].tobytes() == log_blind[name].tobytes()) for name in log.columns))
print("figures of bodies:", sum(kpi.startswith(("posture", "exposure")) for kpi, *_ in exposure(log_blind, blind)))
