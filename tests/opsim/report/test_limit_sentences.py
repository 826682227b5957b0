from opsim.report.sections.exposure_summary import MOST, limit_sentences


def row(kpi, subject, part, mean):
    return {"kpi": kpi, "subject": subject, "part": part, "mean": mean}


def test_a_load_beyond_the_limit_is_said_and_one_within_is_not():
    rows = [row("lifting_index", "pick", "", 1.6), row("lifting_index", "pick", "at_most", 2.1)]
    rows += [row("lifting_index", "pack", "", 0.4), row("lifting_index", "pack", "at_most", 0.5)]
    (said,) = limit_sentences(rows)
    assert "pick" in said and "1.6 to 2.1" in said


def test_what_was_not_asked_for_or_never_known_says_nothing():
    assert limit_sentences([]) == [] and limit_sentences([row("lifting_index", "pick", "", None)]) == []


def test_many_limits_are_cut_and_counted():
    rows = [row("composite_lifting_index", f"w{n}", "", 2.0) for n in range(MOST + 3)]
    said = limit_sentences(rows)
    assert len(said) == MOST + 1 and said[-1].startswith("And 3 more")
