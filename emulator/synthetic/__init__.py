"""Made tasks, walks, cycles and cohorts with known truth: for trying things out, tests, and the shipped bench work."""

from emulator.synthetic.tasks import LICENCE, RATE_HZ, SOURCE, Truth, bench_work_library, draw_bodies, make

__all__ = ["LICENCE", "RATE_HZ", "SOURCE", "Truth", "bench_work_library", "draw_bodies", "make"]
