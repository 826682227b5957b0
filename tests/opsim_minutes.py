"""Rows of a log as people write them down: from when to when, in minutes."""


def minutes(log, kind, worker=None, station=None, cause=None):
    """(from, to) in minutes of the rows of a kind, in time; of a worker, at a station, for a cause where given."""
    keep = log["kind"] == kind
    for column, value in (("worker", worker), ("station", station), ("cause", cause)):
        if value is not None:
            keep = keep & (log[column] == value)
    return sorted(zip((log["start_s"][keep] / 60).tolist(), (log["end_s"][keep] / 60).tolist()))
