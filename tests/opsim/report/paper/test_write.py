import csv

from emulator.judge.paper import Table
from opsim.report.motion.emulator_paper import Picture, Section, cell, write_paper


def page(tmp_path, name="squat", words="ten repetitions"):
    table = Table(4, "variability", ("sequences", "E"), (("recordings", 0.7163), ("<b>PWI</b>", 1e-12)))
    picture = Picture(15, "scaled", '<svg xmlns="http://www.w3.org/2000/svg"></svg>')
    return write_paper(tmp_path, "Judged", ["one & all"], [Section(name, words, (table,), (picture,))])


def test_every_table_and_figure_is_a_file_beside_the_page(tmp_path):
    assert page(tmp_path) == tmp_path / "index.html"
    rows = list(csv.reader((tmp_path / "squat" / "table_4.csv").open()))
    assert rows == [["sequences", "E"], ["recordings", "0.7163"], ["<b>PWI</b>", "1e-12"]]
    assert (tmp_path / "squat" / "figure_15.svg").read_text().startswith("<svg")


def test_the_page_shows_them_and_escapes_names(tmp_path):
    text = page(tmp_path).read_text()
    assert "Table 4: variability" in text and "Figure 15: scaled" in text and "0.7163" in text
    assert "<b>PWI</b>" not in text and "&lt;b&gt;PWI" in text and "one &amp; all" in text


def test_the_page_fetches_nothing(tmp_path):
    text = page(tmp_path).read_text()
    assert "default-src 'none'" in text and "<script" not in text


def test_cells_have_four_figures():
    assert [cell(v) for v in ("word", 0.71634, 669.27, 1e-9)] == ["word", "0.7163", "669.3", "1e-09"]
