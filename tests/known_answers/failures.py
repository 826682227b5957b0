"""Machines that fail: machine repair, two machines and a buffer, transfer lines, interrupted service.

How the models of the books are said here:
Gershwin    : cycles of 1 s; a machine fails as its next cycle would begin, so only where it has a part and room (by
              cycles, geometric); repair takes a geometric number of cycles. N = buffer + 2, since a part that is being
              worked on by the second machine, and one that the first cannot hand on, count.
Buzacott    : without buffers all machines move together and stop together, one failure at a time: one station with the
              breakdowns of all. With room without limit the worst machine decides; the other here fails a fifth as
              often, since with two equal ones the buffer would grow and grow and no run be long enough.
interrupted : failures in use (by busy time), work goes on where it was broken off: M/G/1 of the time a job takes with
              its repairs. Failures by the clock, idle or not: M/M/1 whose server is up and down.
"""

from known_answers.case import Case

_REPAIR = "machine repair N=5 c=1"
_GERSHWIN = "Gershwin two-machine deterministic/geometric line"
_BUZACOTT = "Buzacott zero-buffer and infinite-buffer limits"
_PAIRS = {
    "n4": "p1=0.01,r1=0.1,p2=0.01,r2=0.1,N=4",
    "n10": "p1=0.01,r1=0.1,p2=0.01,r2=0.1,N=10",
    "n20": "p1=0.01,r1=0.1,p2=0.01,r2=0.1,N=20",
    "often": "p1=0.05,r1=0.2,p2=0.05,r2=0.2,N=10",
    "uneven": "p1=0.01,r1=0.1,p2=0.02,r2=0.1,N=10",
}


def stay_interrupted_in_use_s(
    every_s: float, mean_s: float, second_moment: float, up_s: float, repair_s: float
) -> float:
    """Mean stay in M/G/1 whose server fails in use, after exponential times, with exponential repairs.

    A job takes C, its time S and repairs meanwhile: E C = E S (1 + r / u), E C^2 = E S^2 (1 + r / u)^2 + 2 E S r^2 / u.
    Source: Gaver 1962, A waiting line with interrupted service, J. Roy. Statist. Soc. B 24; then Pollaczek & Khinchine.
    """
    slower = 1 + repair_s / up_s
    takes_s = mean_s * slower
    squared = second_moment * slower**2 + mean_s * 2 * repair_s**2 / up_s
    return squared / every_s / (2 * (1 - takes_s / every_s)) + takes_s


def stay_interrupted_any_time_s(every_s: float, mean_s: float, up_s: float, repair_s: float) -> float:
    """Mean stay in M/M/1 whose server fails after exponential times, idle or not, with exponential repairs.

    Source: White & Christie 1958, Queuing with preemptive priorities or with breakdown, Operations Research 6(1).
    """
    arrive, serve, fail, repair = 1 / every_s, 1 / mean_s, 1 / up_s, 1 / repair_s
    both = fail + repair
    return (both**2 + serve * fail) / (both * (repair * serve - arrive * both))


def _two_machines(variant: str, key: str) -> list[Case]:
    return [
        Case("gershwin", variant, "throughput_per_h", (_GERSHWIN, key, "efficiency"), scale=3600.0),
        Case("gershwin", variant, "between_machines", (_GERSHWIN, key, "mean_buffer"), most_half_width=0.02),
    ]


CASES = (
    Case("machine_repair", "base", "machines_down", (_REPAIR, "mean_down"), most_half_width=0.02),
    Case("machine_repair", "base", "repairs_under_way", (_REPAIR, "worker_util")),
    Case("machine_repair", "base", "failures_per_s", (_REPAIR, "failures_per_time")),
    Case("machine_repair", "base", "wait_for_repair_s", (_REPAIR, "mean_wait_for_worker"), most_half_width=0.02),
    Case("machine_repair", "base", "throughput_per_h", (_REPAIR, "availability"), scale=5 * 3600 / 10),
    *(case for variant, key in _PAIRS.items() for case in _two_machines(variant, key)),
    *(
        Case("transfer_line", f"k{k}", "throughput_per_h", (_BUZACOTT, "zero_buffer", str(k)), scale=3600.0)
        for k in (2, 5, 10)
    ),
    Case("gershwin", "infinite", "throughput_per_h", (_BUZACOTT, "infinite_buffer"), scale=3600.0),
    *(
        Case("interrupted", variant, "time_in_system_s", stay_s, most_half_width=0.02)
        for variant, stay_s in {
            "in_use": stay_interrupted_in_use_s(2.0, 1.0, 1.0, 10.0, 2.0),
            "in_use_spread": stay_interrupted_in_use_s(2.0, 1.0, 2.0, 10.0, 2.0),
            "any_time": stay_interrupted_any_time_s(2.0, 1.0, 10.0, 2.0),
        }.items()
    ),
)
