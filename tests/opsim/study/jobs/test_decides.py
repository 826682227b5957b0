from dataclasses import replace

from opsim.study.jobs import Point, Source
from opsim.study.jobs import evaluate as module
from opsim.study.jobs.evaluate import decided_by
from tests.opsim.cli.calls import LINE

POINT = Point("two", {"stations.saw.buffer": 3}, "base")


def decided(folder, text=LINE, point=POINT, **said):
    """As a process of its own would find it."""
    for cache in (module._made_from, module._sha256, module._folder):
        cache.cache_clear()
    from opsim.study.jobs import evaluate

    evaluate._variant.cache_clear()
    (folder / "line.yaml").write_text(text)
    return decided_by(replace(Source(str(folder / "line.yaml"), ("throughput_per_h",)), **said), point)


def test_what_only_says_how_answers_are_looked_at_decides_none(tmp_path):
    first = decided(tmp_path)
    assert decided(tmp_path, LINE.replace("[throughput_per_h, station_states]", "[walked_m]")) == first
    assert decided(tmp_path, LINE.replace("name: Two stations", "name: Other")) == first
    assert decided(tmp_path, LINE.replace("replications: 2", "replications: 9")) == first
    assert decided(tmp_path, LINE + "studies: {sweep: {vary: {stations.saw.buffer: [1, 2]}}}") == first
    assert decided(tmp_path, point=Point("another name", POINT.changes, "base")) == first


def test_what_decides_answers_makes_others(tmp_path):
    found = [
        decided(tmp_path),
        decided(tmp_path, LINE.replace("fixed: 25 s", "fixed: 26 s")),
        decided(tmp_path, LINE.replace("run: {", "run: {warm_up: 1 min, ")),
        decided(tmp_path, seed=4),
        decided(tmp_path, changes={"run.horizon": "30 min"}),
        decided(tmp_path, point=Point("two", {"stations.saw.buffer": 4}, "base")),
    ]
    assert len(set(found)) == len(found)


def test_a_file_that_a_change_names_decides_with_what_is_in_it(tmp_path):
    point = Point("times", {"tasks.cut": {"recorded": "times.csv", "automatic": True}}, "base")
    (tmp_path / "times.csv").write_text("duration_s\n20\n21\n")
    first = decided(tmp_path, point=point)
    (tmp_path / "times.csv").write_text("duration_s\n20\n22\n")
    assert decided(tmp_path, point=point) != first
