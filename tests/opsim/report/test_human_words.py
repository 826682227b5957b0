from opsim.report.sections.learning_fatigue import learned_over_all, tired_over_all


def row(subject, mean, half=0.01, part="", n=8):
    ends = {} if half is None else {"low": mean - half, "high": mean + half}
    return {"subject": subject, "part": part, "mean": mean, "n": n, "low": None, "high": None} | ends


def test_the_most_tired_are_told_with_their_intervals_over_all_replications():
    rows = [row("", 0.3), row("ana", 0.18), row("ben", 0.19), row("ben", 0.4, part="neck")]
    assert list(tired_over_all(rows)) == [
        "The highest fatigue in the mean over 8 replications, with intervals: ben 19.0 % (18.0 to 20.0); "
        "ana 18.0 % (17.0 to 19.0)."
    ]


def test_what_is_left_to_learn_is_told_by_task():
    rows = [row("ana", 0.5), row("ana", 0.43, part="wire"), row("bo", 0.61, part="mount")]
    (said,) = learned_over_all(rows)
    assert "bo, mount 61.0 % (60.0 to 62.0); ana, wire 43.0 % (42.0 to 44.0)." in said


def test_one_replication_says_nothing_of_all():
    assert not list(tired_over_all([row("ana", 0.2, None, n=1)])) and not list(learned_over_all([]))
