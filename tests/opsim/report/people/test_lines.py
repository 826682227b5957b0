from opsim.report.motion.people import compact, notes, overview, pairs, persons, title, total
from tests.made.people import NONE, found

NOBODY = [NONE] * 4


def test_the_compact_table_holds_scores_iccs_and_covariates():
    columns, rows = compact(found())
    assert columns == ["", "known", "pooled", "new", "ICC", "95 %", "R2 height (p)"]
    assert rows == [
        ["posture + duration", "0.87", "1.00", "1.50", "-", "-", "-"],
        ["posture", "0.43", "0.50", "0.50", "-", "-", "-"],
        ["log duration", "0.43", "0.50", "1.00", "0.50", "-0.10 to 0.90", "0.50 (0.01*)"],
        ["pace score 1", "-", "-", "-", "-", "-", "-"],
    ]


def test_without_covariates_there_is_no_column_for_them():
    assert compact(found(told=False))[0][-1] == "95 %"


def test_who_is_not_closer_or_not_judged_is_named_or_counted():
    closer, covariate = notes(found())
    assert closer.startswith("own draws are closer than pooled ones for 1 of 2 people, not for ben; ")
    assert closer.endswith("; 1 has too few repetitions to be judged by") and covariate == "covariate vmax: changes"
    assert notes(found(known=NOBODY, told=False))[0].startswith("nobody could be foretold by his own draws; 3 have")


def test_pairs_of_all_tasks_are_counted_together():
    both = [found(), found("lift", [[0.1, 0.1]] * 4)]
    assert pairs(both) == (4, 5)
    assert total(both) == "own draws are closer than pooled ones for 4 of 5 (task, worker) pairs: 80 %"
    assert total([found(known=NOBODY)]) == "no (task, worker) pair could be judged"


def test_the_overview_has_a_row_a_task_and_people_a_row_each():
    assert overview([found()])[1] == [["reach", "3", "4", "0.50", "-0.10 to 0.90", "0.87", "1.00", "1.50", "1 of 2"]]
    assert persons(found())[1] == [
        ["ana", "2", "2", "0.40", "1.00", "1.50", "yes"],
        ["ben", "1", "1", "1.80", "1.00", "1.50", "no"],
        ["cid", "1", "0", "-", "-", "-", "-"],
    ]
    assert title(found()) == "reach: 4 repetitions of 3 people (all)"
