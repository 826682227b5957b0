"""README, DESIGN and docs: every link leads somewhere, every page is in the index, and what they name is there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGES = [ROOT / "README.md", ROOT / "DESIGN.md", *sorted((ROOT / "docs").glob("*.md"))]
NAMES = [str(path.relative_to(ROOT)) for path in PAGES]


def without_blocks(path):
    return re.sub(r"^```.*?^```$", "", path.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)


def links(path):
    return re.findall(r"\]\(([^)\s]+)\)", without_blocks(path))


def anchors(path):
    """As GitHub makes them of headings: small letters, dashes for spaces, nothing else but letters, digits and _."""
    headings = re.findall(r"^#+ (.+)$", without_blocks(path), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def leads_nowhere(page, link):
    name, _, anchor = link.partition("#")
    target = (page.parent / name).resolve() if name else page
    return not target.exists() or (anchor and anchor not in anchors(target))


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_every_link_leads_to_a_page_and_a_heading(page):
    assert [link for link in links(page) if leads_nowhere(page, link)] == []


def test_every_page_and_picture_is_linked():
    docs = ROOT / "docs"
    assert {path.name for path in docs.glob("[a-z]*.md")} <= set(links(docs / "README.md"))
    shown = {(page.parent / link).resolve() for page in PAGES for link in links(page)}
    assert set((docs / "pictures").iterdir()) <= shown


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_every_file_and_command_of_make_that_is_named_is_there(page):
    text = page.read_text("utf-8")
    files = re.findall(r"(?<![\w/.-])((?:tests|examples|opsim|emulator)/[\w/]+(?:\.\w+)?)", text)
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    assert [name for name in files if not (ROOT / name).exists()] == []
    assert set(re.findall(r"(?:`|^)make ([a-z-]+)", text, re.MULTILINE)) <= targets


def test_readme_and_design_are_read_in_one_go():
    assert len((ROOT / "README.md").read_text("utf-8").splitlines()) <= 150
    assert len((ROOT / "DESIGN.md").read_bytes()) <= 25_000


def test_a_picture_is_small():
    assert all(path.stat().st_size < 150_000 for path in (ROOT / "docs" / "pictures").iterdir())
