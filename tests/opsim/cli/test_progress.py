from opsim.cli.progress import progress


def test_elsewhere_than_on_a_terminal_progress_is_plain_lines(capsys):
    with progress("run base") as report:
        for done in range(1, 101):
            report(done, 100)
    assert capsys.readouterr().err.splitlines()[-1] == "run base: 100 of 100"


def test_quick_steps_do_not_flood_the_log(capsys):
    with progress("run base") as report:
        for done in range(1, 1001):
            report(done, 1000)
    assert len(capsys.readouterr().err.splitlines()) == 2


def test_each_label_is_told_apart(capsys):
    with progress("fit lift") as report:
        report(3, 3, "aligning")
        report(2, 2, "judging")
    assert capsys.readouterr().err == "fit lift: aligning: 3 of 3\nfit lift: judging: 2 of 2\n"


def test_the_time_left_counts_from_the_start_and_not_from_the_first_step(monkeypatch, capsys):
    now = iter([100.0, 110.0])
    monkeypatch.setattr("opsim.cli.progress.time.monotonic", lambda: next(now))
    with progress("run base") as report:
        report(1, 3)
    assert capsys.readouterr().err == "run base: 1 of 3, 20 s left\n"


def times(monkeypatch, *at_s):
    now = iter(at_s)
    monkeypatch.setattr("opsim.cli.progress.time.monotonic", lambda: next(now))


def test_a_label_that_names_the_next_step_leaves_the_clock_alone(monkeypatch, capsys):
    times(monkeypatch, 100.0, 100.0, 120.0)
    with progress("judge") as report:
        report(0, 5, "reach: fitting")
        report(1, 5, "reach: two levels")
    assert capsys.readouterr().err == "judge: reach: fitting: 0 of 5\njudge: reach: two levels: 1 of 5, 80 s left\n"


def test_a_label_that_counts_anew_has_a_clock_of_its_own_and_promises_nothing_at_first(monkeypatch, capsys):
    times(monkeypatch, 100.0, 150.0, 160.0, 170.0)
    with progress("fit") as report:
        report(3, 3, "aligning")
        report(1, 4, "judging")
        report(2, 4, "judging")
    assert capsys.readouterr().err.splitlines()[1:] == ["fit: judging: 1 of 4", "fit: judging: 2 of 4, 20 s left"]


def test_nothing_done_yet_promises_no_time(capsys):
    with progress("run base") as report:
        report(0, 5)
    assert capsys.readouterr().err == "run base: 0 of 5\n"


def test_a_terminal_gets_a_bar(monkeypatch, capsys):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with progress("run [red]base") as report:
        report(1, 2, "half")
    assert "Traceback" not in capsys.readouterr().err
