"""A made shop for the cost of looking: twenty people, sixteen stations, eight hours, a body for all they do."""

from itertools import cycle

from opsim.shipped import shipped_folder

N_STATIONS, N_WORKERS, SKILLS = 16, 20, 4
TASKS = ("reach", "pick", "place", "fasten", "inspect", "lift", "stoop")


def full_shift(
    n_workers: int = N_WORKERS, n_stations: int = N_STATIONS, horizon: str = "8 h", replications: int = 20
) -> str:
    """Three products, each through two thirds of the stations, which stand in four rows."""
    ranks = range(n_stations)
    ways = [[f"s{i}" for i in ranks if i % 3 != product] for product in range(3)]
    tasks = dict(zip(ranks, cycle(TASKS)))
    repeats = {"reach": 6, "pick": 6, "place": 6, "fasten": 3, "inspect": 4, "lift": 4, "stoop": 5}
    skills = [", ".join(f"s{(w + 5 * k) % n_stations}: 1.0" for k in range(SKILLS)) for w in range(n_workers)]
    return "\n".join(
        [
            "opsim: 1",
            "name: Full shift",
            f"run: {{start: Mon 06:00, horizon: {horizon}, warm_up: 30 min, replications: {replications}, seed: 5}}",
            "libraries: {bench: libraries/bench_work.npz, walking: libraries/walking.npz}",
            "walking: {emulator: walking/walk}",
            "layout: {places: {" + ", ".join(f"p{i}: [{4 * (i % 4)} m, {5 * (i // 4)} m]" for i in ranks) + "}}",
            "tasks:",
            *(f"  t_{name}: {{emulator: bench/{name}, repeat: {n}}}" for name, n in repeats.items()),
            "stations:",
            *(f"  s{i}: {{at: p{i}, tasks: [t_{tasks[i]}], servers: 2, buffer: 6}}" for i in ranks),
            "products:",
            *(
                f"  q{n}: {{share: {share}, route: [{', '.join(way)}]}}"
                for n, (way, share) in enumerate(zip(ways, (0.4, 0.3, 0.3)))
            ),
            "release: {kind: poisson, every: 10 s}",
            "workers:",
            *(
                f"  w{w}: {{height: {1.55 + 0.02 * (w % 20):.2f} m, skills: {{{able}}}}}"
                for w, able in enumerate(skills)
            ),
            "allocation: {rule: longest_queue, idle: stay, when_blocked: free}",
            "outputs: [throughput_per_h, worker_states, walked_m, trunk_beyond_20_min_per_h]",
        ]
    )


def write_full_shift(folder, **asked):
    """The file of the shop, beside the libraries that it names: they are found in the shipped folder."""
    assert (shipped_folder() / "libraries" / "bench_work.npz").is_file()
    path = folder / "full_shift.yaml"
    path.write_text(full_shift(**asked))
    return path
