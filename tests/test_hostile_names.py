"""Names that would do harm where they are not treated as text: most cannot be names at all, the rest stay text.

Workers, stations, tasks, products, places and variants are called by letters, digits, ``_``, ``-`` and spaces. Titles,
file names and columns of tables are free: they go through run, report, compare, replay, studies and every export.
"""

import csv
import json
from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in
from tests.browser.chromium import browser
from tests.opsim.cli.calls import opsim

HARM = "<script>window.harmed = 1</script>"
CANNOT_BE = {
    "script": HARM,
    "end of script": "</script><!--",
    "image": '"><img src=x onerror="window.harmed = 1">',
    "out of the folder": "../../x",
    "absolute": "/etc/x",
    "drive": "C:\\x",
    "SQL": '"; DROP TABLE kpis; --',
    "formula": "=1+1",
    "formula by sign": "-2+3",
    "template": "{{ 7 * 7 }}",
    "two lines": "first\nsecond",
    "null byte": "a\0b",
    "turned round": "abc\u202egnp.exe",
    "emoji": "\U0001f469\u200d\U0001f3ed",
    "too long": "w" * 101,
    "spaces at the end": "ana ",
    "nothing": "",
}
LONG, RIGHT_TO_LEFT = "w" * 100, "\u05e9\u05dc\u05d5\u05dd \u05e2\u05d5\u05d1\u05d3"
TITLE = (
    f'</script>{HARM}<!-- "; DROP TABLE kpis; -- ../../x {{{{ 7 * 7 }}}} =1+1\nsecond line \U0001f469\u200d\U0001f3ed'
)
FILE = f"=1+1 {HARM.replace('/', '')} <!--.yaml"
TIMES, COLUMN = '"><img src=x onerror=window.harmed=1>.csv', "=HYPERLINK(1)"


def scenario(worker="ana", station="saw", task="cut", product="part", place="here", variant="base", title="Made"):
    """A scenario as values: a worker at a station, and a variant with a third of the orders."""
    return {
        "opsim": 1,
        "name": title,
        "run": {"horizon": "20 min", "replications": 2, "seed": 3},
        "layout": {"places": {place: ["0 m", "0 m"], "constructor": ["5 m", "1 m"]}},
        "tasks": {task: {"recorded": TIMES, "column": COLUMN}, "NUL": {"fixed": "9 s", "load": "3 kg"}},
        "stations": {
            station: {"at": place, "tasks": [task], "buffer": 3},
            "__proto__": {"at": "constructor", "tasks": ["NUL"]},
        },
        "products": {product: {"route": [station, "__proto__"]}},
        "release": {"kind": "poisson", "every": "40 s"},
        "workers": {worker: {"skills": {station: 1.0, "__proto__": 1.0}}, LONG: {"skills": {"__proto__": 1.0}}},
        "overrides": {"slower": {"release.every": "2 min"}},
        "scenarios": {variant: [], "toString": ["slower"]},
        "studies": {"sweep": {"vary": {"release.every": ["30 s", "60 s"]}}},
    }


@pytest.mark.parametrize("kind", ["worker", "station", "task", "product", "place", "variant"])
@pytest.mark.parametrize("name", CANNOT_BE.values(), ids=CANNOT_BE)
def test_such_a_name_is_refused_with_its_place_in_words_that_can_be_printed(kind, name):
    with pytest.raises(ScenarioError) as refused:
        scenarios_in(json.dumps(scenario(**{kind: name})).encode(), Path("line.yaml"))
    told = str(refused.value)
    assert "cannot be a name" in told or "not allowed" in told or "character" in told
    assert "\0" not in told and "\u202e" not in told and len(told) < 5000


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The folder all was written into, beside a file that must stay alone, and what is said of each command."""
    above = tmp_path_factory.mktemp("above")
    folder = above / "inside"
    folder.mkdir()
    (folder / TIMES).write_text(f"{COLUMN}\n" + "\n".join(str(20 + k % 7) for k in range(40)) + "\n")
    named = {"worker": RIGHT_TO_LEFT, "station": "Start", "task": "CON", "product": "null", "variant": "hasOwnProperty"}
    (folder / FILE).write_text(json.dumps(scenario(**named, title=TITLE), ensure_ascii=False), encoding="utf-8")
    out = folder / "<b>out"
    for words in (
        ["run", folder / FILE, "-o", out],
        ["report", out, "--svg", folder / "figures"],
        ["compare", out],
        ["view", out, "-o", folder / "replay.html"],
        ["sweep", folder / FILE, "-o", folder / "swept", "--processes", 1],
        *(["export", out, "-o", folder / f"events{ending}"] for ending in (".jsonocel", ".sqlite", ".parquet", ".csv")),
        ["export", out, "--figures", "-o", folder / "figures.csv"],
        ["sql", out, "SELECT * FROM kpis", "-o", folder / "asked.csv"],
    ):
        code, _, complaint = opsim(*words)
        assert code == 0, f"{words}\n{complaint}"
    return above, folder


def test_nothing_is_written_outside_the_folder(made):
    above, folder = made
    assert [path.name for path in above.iterdir()] == ["inside"]
    links = [path for path in folder.rglob("*") if path.is_symlink()]
    assert not links and len(list(folder.rglob("*.html"))) >= 5


def test_no_cell_of_a_csv_file_is_a_formula(made):
    for path in made[1].rglob("*.csv"):
        if path.name != TIMES:
            with path.open(encoding="utf-8", newline="") as file:
                cells = [cell for row in csv.reader(file) for cell in row]
            assert cells and not [cell for cell in cells if cell[:1] in ("=", "+", "@", "\t", "\r")]


def test_the_log_in_json_has_the_names_as_they_are(made):
    text = next(path for path in made[1].glob("events*.jsonocel")).read_text(encoding="utf-8")
    values = {a["value"] for one in json.loads(text)["objects"] for a in one.get("attributes", [])}
    names = {one["id"] for one in json.loads(text)["objects"]} | {str(value) for value in values}
    assert any(RIGHT_TO_LEFT in name for name in names) and any(LONG in name for name in names)


@pytest.mark.browser
def test_pages_show_the_names_as_text_and_run_nothing_of_them(made):
    pages = sorted(made[1].rglob("*.html"))
    assert {path.name for path in pages} == {"report.html", "compare.html", "replay.html", "sweep.html"}
    with browser() as chromium:
        for path in pages:
            asked, complaints = [], []
            page = chromium.new_page()
            page.on("request", lambda one, asked=asked: asked.append(one.url))
            page.on("console", lambda one, said=complaints: said.append(one.text) if one.type == "error" else None)
            page.on("pageerror", lambda one, said=complaints: said.append(str(one)))
            page.goto(path.as_uri())
            if path.name in ("report.html", "replay.html"):  # their scripts draw; the others stand as they are written
                page.wait_for_selector("html[data-drawn]")
            assert page.evaluate("window.harmed") is None and complaints == [], path
            assert not [one for one in asked if not one.startswith(("file:", "data:", "blob:"))], path
            assert page.locator("img[src=x]").count() == 0, path
            assert HARM in page.locator("body").inner_text(), path
            page.close()
