"""Machines are shared: hypothesis asks what is true, not how long it takes, and test processes take a core each."""

import os

from hypothesis import settings

if "PYTEST_XDIST_WORKER" in os.environ:  # NOTE: two BLAS threads in each of two processes: up to six times slower
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")

QUICK = 12
"""Examples of a property in ``make test``; ``make evidence`` asks as many as it says: ``--hypothesis-profile full``."""
settings.register_profile("quick", deadline=None, max_examples=QUICK)
settings.register_profile("full", deadline=None)
settings.load_profile("quick")

LONG_FIRST = (
    "test_bad_sets.py",
    "test_examples.py",
    "test_readme.py",
    "test_people.py",
    "test_run.py",
    "test_metamorphic.py",
    "test_motion_fit.py",
    "test_dwell_times.py",
    "test_known_answers.py",
    "test_held_out.py",
    "test_motion.py",
    "test_motion_judge.py",
    "test_subjects.py",
    "test_whole.py",
    "test_reach.py",
    "test_recording_pages.py",
    "test_told.py",
    "test_example_plugin.py",
    "test_architecture.py",
    "test_check.py",
)
"""Files whose tests take longest: begun first, so that no process is left alone with one of them at the end."""


def pytest_addoption(parser):
    parser.addoption(
        "--both-engines", action="store_true", help="what SimPy runs the fast engine runs too, and equally"
    )


def pytest_configure(config):
    if config.getoption("--both-engines"):
        from both_engines import BothEngines

        both = BothEngines()
        both.plant()
        config.pluginmanager.register(both, "both engines")


def pytest_collection_modifyitems(items):
    rank = {name: number for number, name in enumerate(LONG_FIRST)}
    items.sort(key=lambda item: rank.get(item.path.name, len(rank)))
    if settings.default.max_examples == QUICK:
        for item in items:
            few_examples(item.obj)


def few_examples(test):
    """A property that says how many examples it wants is content with few, too."""
    wanted = getattr(test, "_hypothesis_internal_use_settings", None)
    if wanted is not None and wanted.max_examples > QUICK:
        test._hypothesis_internal_use_settings = settings(wanted, max_examples=QUICK)
