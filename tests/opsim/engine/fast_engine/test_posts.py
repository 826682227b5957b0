"""Posts given out by compiled steps against ``opsim.posts``."""

from types import SimpleNamespace

from hypothesis import given, settings
from hypothesis import strategies as st
from made_machine import as_floor, empty_floor, entered
from opsim.engine.fast_engine.rotations import WIDTH, Posts, one_each, posts_of

from opsim.engine.fast_engine.machine import cast, complete, needed, step_of
from opsim.posts import _one_each

as_posts = cast(Posts)


@entered
def give_out(floor_at, posts_at):
    one_each(as_floor(floor_at), as_posts(posts_at))
    return 0


def compiled(n_posts, left, can, keys):
    """{person: post} by the steps. keys : by (person, post)"""
    arena, floor = empty_floor()
    complete(needed([step_of(one_each)]))
    n_members = max(left) + 1
    build = SimpleNamespace(
        arena=arena,
        ints=lambda values: arena.array("int", values),
        floats=lambda values: arena.array("float", values),
    )
    able = [(person, post) in can for post in range(n_posts) for person in range(n_members)]
    posts = posts_of(build, n_posts, n_members, able)
    posts.left.fill(left)
    for (person, post), key in keys.items():
        for i, number in enumerate(key):
            posts.keys[(post * n_members + person) * WIDTH + i] = number
    arena.freeze()
    give_out(floor.address, posts.address)
    return {person: posts.taken[person] for person in left if posts.taken[person] >= 0}


@st.composite
def cases(draw):
    """Some people, who can be at some of a few posts, with keys that are often the same."""
    n_posts = draw(st.integers(1, 5))
    left = sorted(draw(st.sets(st.integers(0, 6), min_size=1, max_size=6)))
    pairs = [(person, post) for person in left for post in range(n_posts)]
    can = {pair for pair in pairs if draw(st.integers(0, 2))}
    keys = {pair: tuple(float(draw(st.integers(0, 2))) for _ in range(WIDTH)) for pair in pairs}
    return n_posts, left, can, keys


@settings(max_examples=300, deadline=None)
@given(cases())
def test_each_post_goes_to_whom_the_rule_gives_it(case):
    n_posts, left, can, keys = case
    known = _one_each(n_posts, left, lambda person, post: (person, post) in can, lambda *pair: keys[pair], 0)
    assert compiled(*case) == known
