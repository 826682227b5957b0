"""Which stopped station a repair team goes to: every stop that waits for it gets a key, the smallest goes first."""


def longest_down(since_s, station_rank, stop_rank):
    """The stop that waits longest."""
    return (since_s, station_rank, stop_rank)
