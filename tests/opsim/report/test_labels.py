from opsim.report.plot.svg_chart import LONGEST, places, shortened


def box(place, name):
    x, y, anchor = place
    left = x if anchor == "start" else x - 8 * len(name)
    return left, y - 12, left + 8 * len(name), y + 3.5


def shared(a, b):
    return max(0, min(a[2], b[2]) - max(a[0], b[0])) * max(0, min(a[3], b[3]) - max(a[1], b[1]))


def test_names_of_points_that_are_near_each_other_do_not_cover_each_other():
    at, names = [(100, 100), (104, 102), (97, 98)], ["one of them", "another", "a third"]
    found = [box(place, name) for place, name in zip(places(at, names, [], 400), names)]
    assert all(shared(a, b) == 0 for i, a in enumerate(found) for b in found[:i])


def test_a_name_at_the_edge_stands_inside():
    ((x, _, anchor),) = places([(390, 50)], ["at the edge"], [], 400)
    assert anchor == "end" and x < 390


def test_a_place_that_is_taken_is_avoided():
    (free,) = places([(100, 100)], ["name"], [], 400)
    (other,) = places([(100, 100)], ["name"], [box(free, "name")], 400)
    assert shared(box(other, "name"), box(free, "name")) == 0


def test_a_long_name_is_cut():
    assert len(shortened("n" * 60)) == LONGEST and shortened("short") == "short"
