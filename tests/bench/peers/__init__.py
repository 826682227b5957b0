"""The same three small factories in opsim and in other simulators, for comparing answers first and CPU time then.

mm1  : arrivals every 1.25 s, one server of 1 s, both exponential
line : ten exponential stations of 1 s, buffers of five, blocking after service, never short of jobs
pool : jobs for twenty stations, eight workers who can each serve those of two of eight groups, exponential, load 0.85

A peer's module is ``in_NAME.py`` with those of ``mm1``, ``line``, ``pool`` that its vocabulary can say. Each takes
``(until_s, times)`` and gives ``(jobs finished before until_s, their mean time in system)``; a line gives its rate
of finished jobs instead of that time. The other simulators are optional: only those that are installed are compared.
"""
