"""When jobs that go together take a server: pure functions, as all rules."""


def batch_begins(n_waiting, size, longest_wait_s, most_wait_s):
    """Whether jobs of one class begin: enough for a full batch, or the first of them has waited as long as it may."""
    return n_waiting >= size or longest_wait_s >= most_wait_s
