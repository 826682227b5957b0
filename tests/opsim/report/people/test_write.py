import re

from opsim.report.motion.people import FILES, write_people
from tests.made.people import NONE, found


def test_the_page_stands_beside_its_tables_and_picture(tmp_path):
    assert write_people(tmp_path / "out", [found()], seed=7) == tmp_path / "out" / "index.html"
    assert {path.name for path in (tmp_path / "out").iterdir()} == {*FILES, "people.svg", "index.html"}
    text = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "1 of 2 (task, worker) pairs" in text and "Seed 7." in text and "a test; MIT" in text
    assert all(f'href="{name}"' in text for name in (*FILES, "people.svg"))


def test_the_page_fetches_nothing_and_escapes_names(tmp_path):
    text = write_people(tmp_path, [found("<b>lift</b> & $x$")], seed=0).read_text(encoding="utf-8")
    assert "default-src 'none'" in text and "<script" not in text and "<b>lift" not in text
    assert (tmp_path / "people.svg").read_text(encoding="utf-8") in text
    assert set(re.findall(r'(?:href|src)="(?!#)([^"]*)"', text)) <= {*FILES, "people.svg"}


def test_the_same_is_written_to_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        write_people(tmp_path / name, [found()], seed=0)
    assert all(path.read_bytes() == (tmp_path / "b" / path.name).read_bytes() for path in (tmp_path / "a").iterdir())


def test_a_task_in_which_nothing_could_be_judged_is_shown_too(tmp_path):
    assert "could be judged" in write_people(tmp_path, [found(known=[NONE] * 4)], seed=0).read_text(encoding="utf-8")
