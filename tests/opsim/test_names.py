from hypothesis import given
from hypothesis import strategies as st

from opsim.problems import natural_key


def test_numbers_in_names_are_read_as_numbers():
    assert sorted(["w10", "w2", "w1b", "w", "w01", "a9"], key=natural_key) == ["a9", "w", "w01", "w1b", "w2", "w10"]


@given(st.lists(st.text(max_size=8), unique=True, max_size=20), st.randoms())
def test_the_order_is_the_same_whatever_comes_first(names, random):
    shuffled = names[:]
    random.shuffle(shuffled)
    assert sorted(names, key=natural_key) == sorted(shuffled, key=natural_key)
