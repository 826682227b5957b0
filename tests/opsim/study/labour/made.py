"""A small line of people who differ, with everything on that a budget may switch off; for tests of the study."""

from opsim.plan import compile_plan
from opsim.scenario.schema.studies import Labour
from opsim.scenario.study_checks import Varied
from opsim.study.jobs import Answers, Source
from opsim.study.labour.study import kept_figures, labour

LINE = """
opsim: 1
name: Three people
run: {start: Mon 06:00, horizon: 24 min, warm_up: 4 min, replications: 2, seed: 5}
layout: {places: {here: [0 m, 0 m]}}
tasks:
  cut:   {dist: lognormal, mean: 50 s, cv: 0.4, between_share: 0.5}
  drill: {dist: lognormal, mean: 50 s, cv: 0.4, between_share: 0.5}
stations:
  saw:   {at: here, tasks: [cut], servers: 2, buffer: 2}
  press: {at: here, tasks: [drill], servers: 2, buffer: 2}
products: {part: {route: [saw, press]}}
release: {kind: saturated}
shifts: {early: {from: 06:00, to: 14:00, breaks: {coffee: {at: 06:10, lasts: 2 min}}}}
workers:
  ana: {skills: {saw: 1.0}, shift: early}
  ben: {skills: {saw: 1.2}, shift: early, absence: 0.1}
  cem: {skills: {press: 1.0}, shift: early, experience: {drill: 40}}
human:
  learning: {model: wright, rate: 0.9, measured_at: 100}
  forgetting: {model: lfcm}
  fatigue: {model: lffrm}
  state_pace: {model: schultz}
outputs: [throughput_per_h, work_in_progress, fatigue_mean]
"""

FEWER = LINE.replace("  forgetting: {model: lfcm}\n", "").replace("  state_pace: {model: schultz}\n", "")
FEWER = FEWER.replace(", absence: 0.1", "").replace(" breaks: {coffee: {at: 06:10, lasts: 2 min}}", " breaks: {}")
"""The same with five sources on."""


def varied(folder, text=LINE):
    path = folder / "line.yaml"
    path.write_text(text)
    return Varied.read(path)


def loaded(folder, text=LINE):
    return varied(folder, text).with_changes({})


def found(folder, text=FEWER, **said):
    """What a labour study of the line finds; said: keys of its block."""
    of = loaded(folder, text)
    block = Labour.model_validate({"workforces": 2, "replications": 2, **said})
    answers = Answers(Source(str(of.file), kept_figures(block, of)), processes=1)
    return labour(block, of, compile_plan(of), None, answers)
