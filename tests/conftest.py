"""Machines are shared: hypothesis asks what is true, not how long it takes."""

from hypothesis import settings

settings.register_profile("shared", deadline=None)
settings.load_profile("shared")
