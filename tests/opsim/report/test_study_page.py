from opsim.report.page import StudyPage, Table, study_html
from opsim.report.page import StudySection as Section


def test_long_text_has_room_on_a_narrow_screen_and_short_text_and_numbers_take_none():
    table = Table(("who", "what", "why", "n"), [("ana", "w" * 20, "why " * 20, "1")], words=3)
    assert table.kinds == ["", "words", "sentence", "number"]
    page = study_html(StudyPage("Line", "sweep", (), (Section("Rows", table=table),)))
    assert '<td>ana</td><td class="words">' in page and '<td class="number">1</td>' in page


def test_a_page_says_scroll_sideways_only_where_a_browser_knows_that_there_is_more():
    page = study_html(StudyPage("Line", "sweep", (), ()))
    assert "display: var(--can-scroll, none)" in page and "animation-timeline: scroll(self inline)" in page
