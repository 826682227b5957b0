from opsim.kpi.catalogue import KPIS, OF_EACH, subject_of


def test_every_figure_that_is_of_one_thing_each_exists_and_is_of_one_kind():
    names = [name for kind in OF_EACH.values() for name in kind]
    assert set(names) <= set(KPIS) and len(names) == len(set(names))


def test_what_is_of_the_whole_too_needs_no_subject():
    assert subject_of("queue_length") == "station" and subject_of("throughput_per_h") == ""
