from opsim.study.long_run.diagnostics import full_stations, nobody_free


def summary(*rows):
    return {"kpis": [dict(zip(("kpi", "subject", "part", "mean"), row)) for row in rows]}


def test_stations_are_full_and_nobody_is_free_where_all_say_so():
    rows = [("station_states", "press", "starved", 0.004), ("station_states", "saw", "starved", 0.1)]
    busy, free = ("worker_states", "Ana", "wait", 0.0), ("worker_states", "Ben", "wait", 0.02)
    assert full_stations(summary(*rows, busy)) == ("press",) and nobody_free(summary(*rows, busy))
    assert not nobody_free(summary(busy, free))


def test_what_is_not_known_proves_nothing():
    unknown = summary(("station_states", "press", "starved", None), ("worker_states", "Ana", "wait", None))
    assert full_stations(unknown) == () and not nobody_free(unknown) and not nobody_free(summary())
