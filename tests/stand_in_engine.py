"""A stand-in for the fast engine, for tests of who asks which engine for what: its rows are those of the reference."""

import os
import sys
from dataclasses import replace
from types import ModuleType

from opsim.engine.floor.run import run_plan

NAME = "opsim.engine.fast_engine"


class StandIn(ModuleType):
    """refuses : what it does not run, in words, or of a Plan; spoil : what is done to its log

    asked_for, ran : Plans it was made ready for; (process, replication) of what it ran in this process
    """

    def __init__(self, refuses=(), parts=3, spoil=lambda log: log):
        super().__init__(NAME)
        self.refuses, self.parts, self.spoil = refuses, parts, spoil
        self.is_compiled, self.costs_s, self.is_kept = False, 20.0, lambda: True
        self.asked_for, self.ran = [], []

    def run_plan(self, plan, replication=0):
        assert self.is_compiled, "run before it was made ready"
        self.ran.append((os.getpid(), replication))
        return self.spoil(run_plan(plan, replication))

    def unsupported(self, plan):
        return list(self.refuses(plan) if callable(self.refuses) else self.refuses)

    def compiling_s(self, plan):
        return 0.0 if self.is_compiled else self.costs_s

    def ready(self, plan, told=None):
        self.asked_for.append(plan)
        if self.is_compiled:
            return
        for done in range(self.parts + 1):
            if told is not None:
                told(done, self.parts)
        self.is_compiled = True


def stand_in(monkeypatch, **how):
    """The stand-in, put in the place of the fast engine for a test."""
    made = StandIn(**how)
    monkeypatch.setitem(sys.modules, NAME, made)
    return made


def spoilt(log, row, column, value):
    """A log with one value changed."""
    columns = {name: of.copy() for name, of in log.columns.items()}
    columns[column][row] = value
    return replace(log, columns=columns)


def install_rule(folder, monkeypatch, group, name, like="lambda *numbers: (0.0, float(numbers[-1]))"):
    """Install a distribution with one rule, for a test."""
    module = f"their_{name}_of_{folder.name}".replace("-", "_")
    info = folder / f"their_{name}" / f"their_{name}-1.0.dist-info"
    info.mkdir(parents=True)
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: their-{name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[{group}]\n{name} = {module}:rule\n")
    (info.parent / f"{module}.py").write_text(f"rule = {like}\n")
    monkeypatch.syspath_prepend(str(info.parent))
