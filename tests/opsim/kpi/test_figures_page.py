"""``docs/figures.md`` says what the catalogue declares; ``python tests/opsim/kpi/test_figures_page.py`` writes it."""

from pathlib import Path

from opsim.kpi.catalogue import DECLARED, KINDS, LESS, MORE

PAGE = Path(__file__).parents[3] / "docs" / "figures.md"
BETTER = {MORE: "more", LESS: "less", "": ""}
HEAD = """# All figures

What `outputs` of a scenario may name, in the order of `opsim/kpi/catalogue.py`, which this page is written from. What
is made only where it is asked for says so under *made for*: postures and walks are drawn again, which takes a while.
More about those of [people](people.md#figures-of-people) and [bodies](ergonomics.md#figures); how they are asked for:
[scenario.md](scenario.md).
"""
COLUMNS = "| figure | what it is | unit | better | one for each | made for |\n|---|---|---|---|---|---|"


def page():
    parts = [HEAD]
    for kind in KINDS:
        parts.append(f"## {kind.capitalize()}\n\n{COLUMNS}")
        parts[-1] += "".join(
            f"\n| `{one.name}` | {one.title} | {one.unit} | {BETTER[one.better]} | {one.of} | {one.needs} |"
            for one in DECLARED
            if one.kind == kind
        )
        parts[-1] += "\n"
    return "\n".join(parts)


def test_the_page_of_figures_is_that_of_the_catalogue():
    assert page() == PAGE.read_text("utf-8")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
