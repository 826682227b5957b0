import pytest
from plans import line, plan

ROUTED = line(3, 1, horizon="1 h").replace("buffer: 1", "buffer: unlimited").replace("saturated", "poisson, every: 5 s")


def visits(way):
    return plan(ROUTED.replace("route: [s1, s2, s3]", way)).products[0].visits()


def test_a_route_visits_each_step_once():
    assert visits("route: [s2, s1, s2, s3]") == (1.0, 1.0, 1.0, 1.0)


@pytest.mark.parametrize("way", ["start: s1, s1: s2, s2: s3, s3: out", "start: s3, s3: s1, s1: s2, s2: out"])
def test_a_sure_routing_is_a_route_whatever_its_order(way):
    assert visits(f"routing: {{{way}}}") == (1.0, 1.0, 1.0)


def test_who_comes_back_is_counted_again():
    way = "routing: {start: s1, s1: s2, s2: {s1: 0.5, s3: 0.25, out: 0.25}, s3: out}"
    assert visits(way) == pytest.approx((2.0, 2.0, 0.5))  # v1 = 1 + v2 / 2, v2 = v1, v3 = v2 / 4
