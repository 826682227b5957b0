"""Machines are shared: hypothesis asks what is true, not how long it takes."""

from hypothesis import settings

settings.register_profile("shared", deadline=None)
settings.load_profile("shared")

LONG_FIRST = (
    "test_known_answers.py",
    "test_readme.py",
    "test_known_staffing.py",
    "test_random_people.py",
    "test_validation.py",
    "test_motion_judge.py",
)
"""Files whose slow tests take longest: begun first, so that no process is left alone with one of them at the end."""


def pytest_collection_modifyitems(items):
    rank = {name: number for number, name in enumerate(LONG_FIRST)}
    items.sort(key=lambda item: rank.get(item.path.name, len(rank)))
