"""Where jobs come to in time, on both engines, with more questions than answers are kept."""

from engine_evidence.rows import first_difference
from opsim.engine.fast_engine.overtime import MOST_KNOWN
from plans import plan

from opsim.engine.fast_engine.run import Machine
from opsim.engine.floor import run_plan
from opsim.log import FINISH, OFF

HEAD = """
opsim: 1
name: reach
run: {start: Mon 06:00, horizon: 8 h, seed: 8}
layout: {places: {bay: [0 m, 0 m]}}
tasks: {run: {dist: lognormal, mean: 40 min, cv: 1.0, automatic: true}, pack: {fixed: 30 s}}
shifts: {early: {from: 06:00, to: 06:20, overtime: {most: 6 h}}}
workers: {ana: {shift: early, skills: {packer: 1}}}
stations:
  packer: {at: bay, tasks: [pack]}
"""


def test_answers_that_are_not_kept_are_found_again():
    """Of 90 ovens one after the other has a run that will not be over in time: a question of its own each time."""
    ovens = [f"o{n:02d}" for n in range(90)]
    text = HEAD + "".join(f"  {name}: {{at: bay, tasks: [run], buffer: 0}}\n" for name in ovens)
    text += f"products: {{{', '.join(f'p{name}: {{route: [{name}, packer]}}' for name in ovens)}}}\n"
    text += f"sources: {{{', '.join(f's{name}: {{kind: saturated, products: [p{name}]}}' for name in ovens)}}}\n"
    made = plan(text)
    machine, log = Machine(made), run_plan(made)
    assert first_difference(log, machine.run(0)) == ""
    assert len(log.of(FINISH)) > MOST_KNOWN and len(log.of(OFF))
    assert len(machine.floor.people.needs.known) == MOST_KNOWN
