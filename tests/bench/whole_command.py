"""A whole ``opsim`` command in a process of its own: seconds by the clock, seconds of CPU and most memory."""

import os
import subprocess
import sys
from dataclasses import dataclass
from time import perf_counter

RUN = """
import atexit, resource, sys
def said():
    mine, theirs = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    cpu_s = [used.ru_utime + used.ru_stime for used in (mine, theirs)]
    print("used", *cpu_s, mine.ru_maxrss / 1024, theirs.ru_maxrss / 1024, file=sys.stderr)
atexit.register(said)
from opsim.cli import main
main()
"""


@dataclass(frozen=True)
class Used:
    """wall_s by the clock; own_s, children_s of CPU; own_mb, largest_child_mb: most memory at any time."""

    wall_s: float
    own_s: float
    children_s: float
    own_mb: float
    largest_child_mb: float


def opsim(caches, *words):
    """Run a command to its good end. Compiled modules are kept in ``caches``, as an installed package keeps them."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPYCACHEPREFIX"] = str(caches)
    started = perf_counter()
    command = [sys.executable, "-c", RUN, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment)
    wall_s = perf_counter() - started
    assert done.returncode == 0, done.stderr
    used = next(line for line in reversed(done.stderr.splitlines()) if line.startswith("used "))
    return Used(wall_s, *map(float, used.split()[1:]))
