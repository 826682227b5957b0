import json

import pytest

from opsim.cli.compare import check_asked, frontier_texts
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.subjects.human.catalogue import EFFECTS, catalogue
from opsim.subjects.human.plan import NO_EFFECTS
from tests.human_plans import LINE as LINE_of_compare_asked
from tests.opsim.cli.calls import LINE, line, opsim

TWO = LINE.replace("replications: 2", "replications: 3") + (
    "overrides: {wide: {stations.press.servers: 2}, same: {release.when_full: wait}}\n"
    "scenarios: {base: [], wider: [wide], same: [same]}\n"
)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compared")
    code, shown, _ = opsim("compare", line(folder, TWO), "-o", folder / "out")
    assert code == 0 and "comparison:" in shown
    return folder / "out"


def test_a_file_is_run_and_its_variants_compared(results):
    code, shown, _ = opsim("compare", results)
    assert code == 0
    assert "Throughput" in shown and "wider" in shown and "higher" in shown and "identical" in shown
    assert "3 pairs of replications" in shown and "Holm" in shown
    page = (results / "compare.html").read_text(encoding="utf-8")
    assert "<svg" in page and "http://" not in page.replace("http://www.w3.org/2000/svg", "") and "<script" not in page


def test_the_answer_comes_first_in_sentences_on_the_screen_and_on_the_page(results):
    _, shown, _ = opsim("compare", results)
    lines = shown.splitlines()
    assert lines[0] == "Two stations: variants compared with base" and len(lines) <= 20
    assert lines[1].startswith("wider: no clear difference in throughput (+")
    assert lines[2] == "same is identical to base in every replication."
    page = (results / "compare.html").read_text(encoding="utf-8")
    assert 0 < page.index("wider: no clear difference in throughput (+") < page.index("<table>")


def test_where_no_variant_is_called_base_the_first_of_the_file_is_it(tmp_path):
    text = TWO.replace("{base: [], wider: [wide], same: [same]}", "{today: [], alike: [same]}")
    code, shown, _ = opsim("compare", line(tmp_path, text), "-o", tmp_path / "out")
    assert code == 0 and "variants compared with today" in shown and "alike is identical to today" in shown


def test_the_comparison_as_json(results):
    code, shown, _ = opsim("compare", results, "--json")
    found = {(d["variant"], d["kpi"]): d for d in json.loads(shown)["differences"]}
    assert code == 0 and found["same", "throughput_per_h"]["difference"] == 0
    wider = found["wider", "throughput_per_h"]
    assert wider["difference"] == pytest.approx(wider["mean"] - wider["base"]) and wider["n"] == 3


def test_another_base_and_a_named_figure(results):
    code, shown, _ = opsim("compare", results, "--base", "wider", "--kpi", "station_states", "--json")
    found = json.loads(shown)["differences"]
    assert (
        code == 0
        and {d["kpi"] for d in found} == {"station_states"}
        and {d["subject"] for d in found}
        == {
            "saw",
            "press",
        }
    )


@pytest.mark.parametrize(
    "words, said",
    [
        (["--kpi", "throughput_per_hour"], "did you mean 'throughput_per_h'"),
        (["--base", "wide"], "did you mean 'wider'"),
        (["--seed", "3"], "--seed: only where a scenario FILE is run"),
        (["--frontier", "throughput_per_hour,time_in_system_s"], "did you mean 'throughput_per_h'"),
        (["--frontier", "throughput_per_h"], "expected two figures and a comma between them"),
        (["--frontier", "throughput_per_h,station_states/saw/work"], "which way is better depends on who asks"),
    ],
)
def test_a_wrong_call_is_answered_with_what_is_right(results, words, said):
    code, _, complaint = opsim("compare", results, *words)
    assert code == 2 and said in complaint


def test_two_figures_are_set_against_each_other_in_table_page_and_json(results):
    words = ("compare", results, "--frontier", "throughput_per_h,time_in_system_s")
    code, shown, _ = opsim(*words)
    assert code == 0 and "Two figures against each other" in shown and "more is better" in shown
    assert 'id="frontier"' in (results / "compare.html").read_text(encoding="utf-8")
    found = json.loads(opsim(*words, "--json")[1])["frontier"]
    assert found["x"]["better"] == "more" and [one["variant"] for one in found["variants"]] == ["base", "same", "wider"]
    assert "frontier" not in json.loads(opsim("compare", results, "--json")[1])


def test_a_scenario_that_asks_for_a_frontier_has_one(tmp_path):
    text = TWO.replace("replications: 3", "replications: 2") + "frontier: [throughput_per_h, time_in_system_s]\n"
    code, shown, _ = opsim("compare", line(tmp_path, text), "-o", tmp_path / "out")
    assert code == 0 and "Two figures against each other" in shown


@pytest.mark.parametrize(
    "words, said",
    [
        (["--frontier", "throughput_per_hour,time_in_system_s"], "did you mean 'throughput_per_h'"),
        (["--frontier", "throughput_per_h,queue_length"], "it is of each station: say which, such as queue_length/"),
        (["--frontier", "throughput_per_h,less queue_length/pres"], "did you mean 'press'"),
        (["--frontier", "throughput_per_h,rula_mean"], "it is made where the scenario's 'outputs' list it"),
        (["--frontier", "throughput_per_h"], "expected two figures and a comma between them"),
        (["--base", "wide"], "did you mean 'wider'"),
        (["--kpi", "throughput_per_hour"], "did you mean 'throughput_per_h'"),
    ],
)
def test_names_that_do_not_exist_are_found_before_anything_is_run(tmp_path, words, said):
    code, shown, complaint = opsim("compare", line(tmp_path, TWO), "-o", tmp_path / "out", *words)
    assert code == 2 and said in complaint and not shown and not (tmp_path / "out").exists()


def test_after_the_runs_no_frontier_takes_the_comparison_with_it(tmp_path):
    words = ("--frontier", "throughput_per_h,first_pass_yield")
    code, shown, complaint = opsim("compare", line(tmp_path, TWO), "-o", tmp_path / "out", *words)
    assert code == 0 and "wider" in shown and (tmp_path / "out" / "compare.html").is_file()
    assert "no picture of two figures against each other: no figure 'first_pass_yield'" in complaint


@pytest.mark.parametrize("words", [[], ["--json"]])
def test_where_no_page_can_be_written_the_table_is_told_all_the_same(results, monkeypatch, words):
    def refuse(path, _):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("opsim.report.comparison.write_text", refuse)
    code, shown, complaint = opsim("compare", results, *words)
    assert code == 1 and "wider" in shown and "comparison: " not in shown
    assert complaint == f"{results / 'compare.html'}: cannot be written: Permission denied\n"
    assert not words or json.loads(shown)["page"] is None


def test_another_run_in_the_folder_is_met_with_what_compare_can_do(results, tmp_path):
    code, _, complaint = opsim("compare", line(tmp_path, TWO), "--seed", 99, "-o", results)
    assert code == 2 and "--overwrite" not in complaint
    assert (
        complaint.splitlines()[-1]
        == f"take another folder with -o, or 'opsim compare {results}' to compare what is there"
    )


def test_damaged_figures_are_named(results, tmp_path):
    import shutil

    shutil.copytree(results, tmp_path / "copy")
    (tmp_path / "copy" / "wider" / "kpis.parquet").write_bytes(b"PAR1")
    code, _, complaint = opsim("compare", tmp_path / "copy")
    assert code == 2 and "wider/kpis.parquet" in complaint


HUMAN = """
human: {fatigue: {model: lffrm}}
overrides: {off: {human: null}}
scenarios: {base: [], plain: [off]}
"""


@pytest.fixture(scope="module")
def variants(tmp_path_factory):
    return scenarios_in((LINE_of_compare_asked + HUMAN).encode(), tmp_path_factory.mktemp("asked") / "line.yaml")


def refused(variants, *words):
    with pytest.raises(ValueError) as error:
        check_asked(variants, *words)
    return str(error.value).splitlines()


def test_all_that_is_wrong_is_said_at_once(variants):
    said = refused(variants, "bass", ["walked"], "queue_length/d,worker_states/ana/wait")
    assert said[0].startswith("no variant 'bass' to compare with; did you mean 'base'")
    assert said[1].startswith("no figure 'walked'") and said[2].startswith("queue_length/d: no station 'd'")
    assert said[3].startswith("worker_states/ana/wait: which way is better depends on who asks") and len(said) == 4


def test_what_can_be_had_is_not_refused(variants):
    check_asked(variants, "base", ["walked_m"], "throughput_per_h,fatigue_mean")
    check_asked(variants, "base", [], "throughput_per_h,queue_length/a")
    check_asked(variants, "base", [], None)


def test_figures_of_postures_that_no_run_makes_and_one_figure_twice_are_refused(variants):
    assert "'outputs' list it" in refused(variants, "base", ["rula_mean"], None)[0]
    assert "two different figures" in refused(variants, "base", [], "walked_m/ana, walked_m/ana")[0]
    assert frontier_texts("a , b") == ["a", "b"] and frontier_texts(None) is None


def test_human_null_in_an_override_switches_all_effects_off(variants):
    assert compile_plan(variants["plain"]).human is NO_EFFECTS
    assert compile_plan(variants["base"]).human.fatigue is not None


def test_every_effect_is_listed_with_its_source():
    code, shown, _ = opsim("effects")
    assert code == 0
    assert all(one.model in shown and one.source[:20] in shown for one in catalogue())


@pytest.mark.parametrize("effect", EFFECTS)
def test_every_parameter_of_an_effect_is_listed(effect):
    code, shown, _ = opsim("effects", effect)
    assert code == 0
    names = [one.name.removesuffix("_s") for found in catalogue() if found.effect == effect for one in found.parameters]
    assert all(name in shown for name in names)


def test_machines_get_defaults_and_neutral_values():
    code, shown, _ = opsim("effects", "circadian", "--json")
    (one,) = json.loads(shown)["effects"]
    amplitude = {"name": "amplitude", "unit": "", "default": 0.05, "neutral": 0.0}
    assert code == 0 and one["model"] == "cosine" and amplitude.items() <= one["parameters"][0].items()


def test_an_unknown_effect_is_a_mistake_with_the_nearest_word():
    assert opsim("effects", "fatige" if "fatigue" in EFFECTS else "learnin")[0] == 2
    code, _, complaint = opsim("effects", "learnin")
    assert code == 2 and complaint == "no effect 'learnin'; did you mean 'learning'?\n"


def test_keys_of_all_effects_are_told_below_the_table():
    _, shown, _ = opsim("effects")
    assert "acts_on: posture" in shown and "absence: 0.05" in shown
