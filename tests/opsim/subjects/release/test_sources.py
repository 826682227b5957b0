"""Sources that say too little, too much, or name what is not there: refused, with the place and the way out."""

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

TEXT = """
opsim: 1
name: two products
run: {horizon: 1 h}
layout: {places: {hall: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {s1: {at: hall, tasks: [t], buffer: 2}, s2: {at: hall, tasks: [t], buffer: 2}}
products: {a: {share: 0.5, route: [s1, s2]}, b: {share: 0.5, route: [s2]}}
release: {kind: poisson, every: 30 s}
"""
RELEASE = "release: {kind: poisson, every: 30 s}"


def read(text, folder):
    return scenarios_in(text.encode(), folder / "two.yaml")["base"]


def printed(release, folder):
    with pytest.raises(ScenarioError) as caught:
        read(TEXT.replace(RELEASE, release), folder)
    return str(caught.value)


def said(release, folder):
    with pytest.raises(ScenarioError) as caught:
        read(TEXT.replace(RELEASE, release), folder)
    return "\n".join(f"{p.path}: {p.message} | {p.hint}" for p in caught.value.problems)


GOOD = [
    "release: {kind: poisson, every: 30 s, products: {a: 1/4, b: 3/4}, at_once: 3}",
    "release: {kind: saturated, sequence: [a, a, b]}",
    "sources: {x: {kind: poisson, every: 30 s, products: [a]}, y: {kind: saturated, products: [b]}}",
    "sources: {x: {kind: schedule, file: orders.csv}, y: {kind: renewal, every: {fixed: 9 s}, sequence: mix.csv}}",
]


@pytest.mark.parametrize("release", GOOD)
def test_every_form_is_read(release, tmp_path):
    (tmp_path / "orders.csv").write_text("time,product\n0,a\n")
    (tmp_path / "mix.csv").write_text("product\na\nb\n")
    read(TEXT.replace(RELEASE, release), tmp_path)


@pytest.mark.parametrize(("release", "expected"), [
    ("", ": nothing says how jobs come in | add e.g. 'release: {kind: poisson, every: 55 s}'"),
    ("sources: {}", ": nothing says how jobs come in |"),
    (RELEASE + "\nsources: {x: {kind: saturated}}", "sources: jobs come in by release and by sources |"),
    ("sources: {x: {kind: saturatd}}", "sources.x.kind: expected saturated, poisson"),
    ("sources: {x: {kind: poisson}}", "sources.x: a poisson release needs the mean time between two jobs |"),
    ("sources: {x: {kind: poisson, every: 30}}", "sources.x.every: 30 has no unit"),
    ("release: {kind: poisson, evry: 30 s}", "release.evry: unknown key 'evry' | did you mean 'every'?"),
    ("release: {kind: poisson, every: 30 s, at_once: 0}", "release.at_once: must be at least 1, found 0"),
    ("release: {kind: saturated, at_once: 2}", "release.at_once: a saturated release has no 'at_once'"),
    ("release: {kind: poisson, every: 3 s, level: 2}", "release.level: a poisson release has no 'level'"),
    ("release: {kind: base_stock, store: x, level: 2, when_full: lose}", "a base_stock release loses nothing"),
    ("release: {kind: schedule}", "release: a schedule needs the file of its orders"),
    ("release: {kind: base_stock, level: 3}", "release: a base_stock release needs its store | add e.g."),
    ("release: {kind: base_stock, store: rack, level: 3}", "release.store: no store 'rack' | there are no stores yet"),
    ("release: {kind: saturated, products: [a, c]}", "release.products[1]: no product 'c' | known products: a, b"),
    ("release: {kind: saturated, products: {a: 0.9, b: 0.3}}", "release.products: the shares sum to 1.2; they must"),
    ("release: {kind: saturated, products: {a: 1.2}}", "release.products.a: a probability lies between 0 and 1"),
    ("release: {kind: saturated, products: [a, a]}", "release.products[1]: 'a' is named twice"),
    ("release: {kind: saturated, products: []}", "release.products: expected a list of products, found an empty"),
    ("release: {kind: saturated, sequence: [a, x]}", "release.sequence[1]: no product 'x'"),
    ("release: {kind: saturated, sequence: mix.csv}", "release.sequence: no file 'mix.csv' in the scenario's folder"),
    ("release: {kind: saturated, sequence: [a], products: [a]}", "release.sequence: the products come from products"),
    ("release: {kind: schedule, file: none.csv}", "release.file: no file 'none.csv'"),
    ("release: {kind: schedule, file: ../x.csv}", "release.file: cannot use '../x.csv'"),
    ("sources: {x: {kind: renewal, every: {recorded: no.csv}}}", "sources.x.every.recorded: no file 'no.csv'"),
])  # fmt: skip
def test_what_is_wrong_with_a_source_is_told_at_its_place(release, expected, tmp_path):
    assert expected in said(release, tmp_path)


def test_all_mistakes_of_an_order_list_are_told_at_once(tmp_path):
    (tmp_path / "orders.csv").write_text("time,product\n-1,a\n2,c\n1,a\n")
    found = printed("release: {kind: schedule, file: orders.csv}", tmp_path)
    assert "orders.csv:2:1: release.file: time '-1' is not" in found
    assert "orders.csv:3:3: release.file: no product 'c'\n     3 | 2,c\n       |   ^ products: a, b" in found
    assert "orders.csv:4:1: release.file: time '1' is before that of the order above" in found


@pytest.mark.parametrize(("text", "remedy"), [
    ("", "^ fill it, or name another file"),
    ("time,product\n", "^ add a line for each order or product"),
    ("product\na\n", "^ its first line must name the columns: time"),
    ('time,product\n"-1","a"\n', "^ from 0 on, such as 90"),
])  # fmt: skip
def test_an_order_list_that_cannot_be_used_gets_a_remedy(text, remedy, tmp_path):
    (tmp_path / "orders.csv").write_text(text)
    assert remedy in printed("release: {kind: schedule, file: orders.csv}", tmp_path)


def test_products_come_from_the_file_or_from_the_source_but_not_from_both(tmp_path):
    (tmp_path / "orders.csv").write_text("time,product\n1,a\n")
    assert "the products come from 'orders.csv' and from the source" in said(
        "release: {kind: schedule, file: orders.csv, products: [a]}", tmp_path
    )
    (tmp_path / "orders.csv").write_text("time\n1\n")
    read(TEXT.replace(RELEASE, "release: {kind: schedule, file: orders.csv, products: [a]}"), tmp_path)


def test_shares_of_products_need_sum_to_1_only_where_a_source_goes_by_them(tmp_path):
    text = TEXT.replace("share: 0.5, route: [s2]", "share: 0.9, route: [s2]")
    read(text.replace(RELEASE, "release: {kind: saturated, products: [a]}"), tmp_path)
    with pytest.raises(ScenarioError, match=r"the shares sum to 1\.4"):
        read(text, tmp_path)


def test_a_mistyped_section_is_one_mistake(tmp_path):
    with pytest.raises(ScenarioError) as caught:
        read(TEXT.replace("release:", "realease:"), tmp_path)
    assert len(caught.value.problems) == 1


def test_an_override_of_the_kind_drops_what_belonged_to_the_old_one(tmp_path):
    (tmp_path / "below.yaml").write_text("sources: {x: {kind: poisson, every: 30 s, products: [a]}}\n")
    text = TEXT.replace(RELEASE, "include: below.yaml\nsources: {x: {kind: saturated}}")
    source = read(text, tmp_path).scenario.sources["x"]
    assert (source.kind, source.every, source.products) == ("saturated", None, {"a": 1.0})
