"""What is kept on disk is found again by a process that has compiled nothing."""

import subprocess
import sys

KEPT = """
from opsim.engine.fast_engine import lowering
from opsim.engine.fast_engine.machine.code_cache import can_link
from opsim.engine.fast_engine.machine.steps import STEPS
from opsim.engine.fast_engine.machine.code_cache import path_of, read

lowering.know_all()
kept = {one.name: read(path_of(one.function, one.line)) for one in STEPS.values()}
print([name for name, code in kept.items() if code is not None and not can_link(code)])
"""


def test_a_process_that_has_compiled_nothing_can_link_every_step_that_is_kept():
    done = subprocess.run([sys.executable, "-c", KEPT], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
