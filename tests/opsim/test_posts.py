"""Who is at which post: by turns, with people missing, with people who cannot do everything."""

import random
from itertools import permutations

from opsim.layout import given_out, turns_away


def by_turns(n_posts, people, turn, can=lambda person, post: True):
    place = {person: number for number, person in enumerate(people)}
    n_slots = max(n_posts, len(people))
    return given_out(n_posts, people, can, lambda p, slot: (turns_away(place[p], turn, slot, n_slots), p))


def test_everybody_moves_up_by_one_post_and_the_last_to_the_first():
    assert [by_turns(3, [0, 1, 2], turn) for turn in range(4)] == [
        {0: 0, 1: 1, 2: 2},
        {0: 1, 1: 2, 2: 0},
        {0: 2, 1: 0, 2: 1},
        {0: 0, 1: 1, 2: 2},
    ]


def test_more_people_than_posts_are_two_at_the_first_ones_and_all_come_to_all_posts():
    assert by_turns(2, [0, 1, 2], 0) == {0: 0, 1: 1, 2: 0}
    assert by_turns(3, [0, 1, 2, 3, 4], 0) == {0: 0, 1: 1, 2: 2, 3: 0, 4: 1}
    assert [by_turns(2, [0, 1, 2], turn)[0] for turn in range(6)] == [0, 1, 0, 0, 1, 0]


def test_fewer_people_than_posts_go_on_to_the_empty_ones():
    assert [by_turns(2, [7], turn) for turn in range(3)] == [{7: 0}, {7: 1}, {7: 0}]
    assert [by_turns(3, [0, 1], turn) for turn in range(3)] == [{0: 0, 1: 1}, {0: 1, 1: 2}, {0: 2, 1: 0}]


def test_who_is_missing_leaves_no_post_empty_while_another_one_is_double():
    """Of four the second is missing: three men for three posts."""
    for turn in range(6):
        assert sorted(by_turns(3, [0, 2, 3], turn).values()) == [0, 1, 2]


def test_a_post_goes_to_somebody_who_can_even_where_another_one_has_to_move_for_him():
    """By turns the first is at post 0, where the second would be alone able to go."""
    assert by_turns(2, [0, 1], 0, lambda person, post: person == 0 or post == 0) == {1: 0, 0: 1}


def test_who_can_be_nowhere_has_no_post():
    assert by_turns(2, [0, 1], 0, lambda person, post: person == 1) == {1: 1}


def test_as_many_posts_are_manned_as_can_be_and_the_first_ones_first():
    """Against trying all ways to give the posts out, in 300 random cases; where fewer people can do anything
    than there are posts, it is those whose turn it is."""
    rng = random.Random(4)
    for _ in range(300):
        n_posts, n_people = rng.randint(1, 3), rng.randint(3, 5)
        can = {(p, post) for p in range(n_people) for post in range(n_posts) if rng.random() < 0.4}
        at = by_turns(n_posts, list(range(n_people)), rng.randint(0, 5), lambda p, post: (p, post) in can)  # noqa: B023
        assert all((p, post) in can for p, post in at.items())
        assert set(at) == {p for p, _ in can}
        best = max(
            tuple((p, post) in can for post, p in enumerate(way)) for way in permutations(range(n_people), n_posts)
        )
        manned = tuple(post in at.values() for post in range(n_posts))
        assert sum(manned) == sum(best)
        assert manned == best or len(at) < n_posts
