from hypothesis import given
from hypothesis import strategies as st

from opsim.viewer.floor import NEAR_M, Site, facings, kept

PLACES = st.lists(
    st.tuples(st.integers(0, 30), st.integers(0, 30)).map(lambda p: (float(p[0]), float(p[1]))), min_size=1, max_size=8
)


def site(points):
    return Site([f"p{rank}" for rank in range(len(points))], tuple(points), [])


@given(PLACES, PLACES)
def test_a_place_with_the_same_around_it_faces_the_same_way_in_two_variants(points, far):
    one = site(points)
    other = site([*points, *((x + 30.0 + NEAR_M, y) for x, y in far)])
    alone, beside = facings(one, {}), facings(other, kept(other, one))
    assert beside[: len(points)] == alone
    assert kept(one, one) == dict(zip(one.names, alone))


def test_a_place_to_whose_side_something_came_is_looked_at_again():
    one, other = site([(0.0, 0.0), (9.0, 0.0)]), site([(0.0, 0.0), (9.0, 0.0), (1.0, 0.0)])
    assert set(kept(other, one)) == {"p1"}
