"""Calling the command line as a user does."""

import numpy as np
from click.testing import CliRunner

from opsim.cli import main

LINE = """
opsim: 1
name: Two stations
run: {horizon: 20 min, replications: 2, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks:
  cut: {dist: exponential, mean: 20 s, automatic: true}
  drill: {fixed: 25 s, automatic: true}
stations:
  saw: {at: here, tasks: [cut], buffer: 2}
  press: {at: here, tasks: [drill], buffer: 2}
products: {part: {route: [saw, press]}}
release: {kind: saturated}
outputs: [throughput_per_h, station_states]
"""


def opsim(*words, env=None):
    """(exit code, stdout, stderr) of a call; a traceback fails the test at once."""
    result = CliRunner().invoke(main, [str(word) for word in words], env=env)
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    assert "Traceback" not in result.stderr
    return result.exit_code, result.stdout, result.stderr


def one_person(recording):
    """Rewrite a recording file as of one person: drawn performances are each of another."""
    with np.load(recording) as file:
        arrays = {**file}
    np.savez(recording, **{**arrays, "subject": np.full(len(arrays["trial"]), "emulated")})


def line(folder, text=LINE, name="line.yaml"):
    """A scenario file that runs without people and libraries."""
    path = folder / name
    path.write_text(text)
    return path
