"""Human effects on time and quality: frozen models, each by name, each off unless a scenario names it.

Nothing here knows of an engine; ``opsim.human.catalogue`` lists all of them with sources, parameters, neutral values.
"""
