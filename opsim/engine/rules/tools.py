"""Tools: who may take them."""


def enough(n_free, n_wanted):
    """Whether as many are free as are wanted."""
    return n_free >= n_wanted
