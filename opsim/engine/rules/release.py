"""When a source makes a job: of several that can, which one; and whether a store wants one more."""


def source_in_turn(n_released, source_rank):
    """Of several saturated sources the one that has made fewest jobs."""
    return (n_released, source_rank)


def stock_wanted(n_on_floor, n_waited_for, level):
    """Pieces that a base stock lacks: level + waited for - pieces in the store or on the way to it; 0 if none."""
    return max(0, level + n_waited_for - n_on_floor)
