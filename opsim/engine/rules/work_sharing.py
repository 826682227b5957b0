"""Work sharing: whether a station does the shared task itself, or leaves it to the next one."""


def keeps_shared(n_inside, servers, buffer, filled):
    """The half-full-buffer rule, with ``filled`` 0.5: the next station has no free server and ``filled`` of its buffer.

    n_inside : jobs at the next station, in its buffer and on its servers

    Source: Ostolaza, McClain & Thomas 1990, The use of dynamic (state-dependent) assembly-line balancing to improve
    throughput, J. Manufacturing and Operations Management 3:105-133; McClain, Thomas & Sox 1992, "On-the-fly" line
    balancing with very little WIP, Int. J. Production Economics 27:283-289.
    """
    return n_inside >= servers and n_inside - servers >= filled * buffer
