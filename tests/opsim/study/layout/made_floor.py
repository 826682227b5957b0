"""A small floor for tests of layouts: three stations in a row, two free places, one who carries every part."""

from opsim.scenario.schema.studies import LayoutStudy
from opsim.scenario.study_checks import Varied
from opsim.study.jobs import Answers, Source
from opsim.study.layout.study import asked_of

FLOOR = """
opsim: 1
name: three in a row
run: {horizon: 1 h, replications: 3, seed: 3}
layout:
  places: {p1: [0 m, 0 m], p2: [5 m, 0 m], p3: [10 m, 0 m], p4: [15 m, 0 m], p5: [20 m, 0 m], door: [0 m, 9 m]}
tasks: {t: {dist: lognormal, mean: 20 s, cv: 0.2}}
stations:
  saw:   {at: p1, tasks: [t], buffer: 2}
  drill: {at: p5, tasks: [t], buffer: 2}
  pack:  {at: p3, tasks: [t], buffer: 2}
products: {part: {route: [saw, drill, pack], carried: true}}
release: {kind: saturated}
cards: {loop: {n: 2}}
workers: {ana: {home: door, skills: {saw: 1.0, drill: 0.9, pack: 1.0}}, ben: {like: ana, zone: [drill, pack]}}
"""


def written(folder, text=FLOOR, name="floor.yaml"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return str(path)


def asked(file, **block):
    varied = Varied.read(file)
    return asked_of(varied, varied.with_changes({}), LayoutStudy.model_validate(block), None)


def answers(file, of):
    return Answers(Source(file, of.kept), processes=1)
