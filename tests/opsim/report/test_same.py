from opsim.report.material import Same


def test_only_the_very_same_is_the_same():
    one, other = {"a": 1}, {"a": 1}
    assert Same(one) == Same(one) and hash(Same(one)) == hash(Same(one)) and Same(one) != Same(other)
