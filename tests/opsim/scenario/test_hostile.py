"""Files made to keep a reader busy, or to steer a terminal: refused quickly, with a place."""

import time
from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

GOOD = (Path(__file__).parent / "good.yaml").read_text(encoding="utf-8")


def lines(section, pattern, n):
    """The good scenario with n more lines at the head of a section."""
    assert f"{section}:\n" in GOOD
    return GOOD.replace(f"{section}:\n", f"{section}:\n{''.join(pattern.format(i=i, j=i + 1) for i in range(n))}")


HOSTILE = {
    "a million keys": ("".join(f"k{i}: 1\n" for i in range(1_000_000)), "larger than 8 MB"),
    "half a million keys": ("".join(f"k{i}: \n" for i in range(500_000)), "the file has 500,000 lines"),
    "too many keys in a line": ("{" + ", ".join(f"k{i}: " for i in range(210_000)) + "}", "200,000 values"),
    "deep lists": ("[" * 100_000, "more than 30 deep"),
    "deep blocks": ("{a: " * 100_000, "more than 30 deep"),
    "an alias bomb": (
        "a: &b0 [1,1,1,1,1,1,1,1,1]\n"
        + "".join(f"b{i}: &b{i} [{', '.join([f'*b{i - 1}'] * 9)}]\n" for i in range(1, 9)),
        "more than 200,000 values",
    ),
    "many unknown keys": (GOOD + "".join(f"k{i}: 1\n" for i in range(15_000)), "unknown key 'k0'"),
    "unknown places among many": (
        lines("  places", "    p{i}: [0 m, 0 m]\n", 10_000).replace(
            "stations:\n", "stations:\n" + "".join(f"  s{i}: {{at: q{i}, tasks: [lift]}}\n" for i in range(300))
        ),
        "no place 'q0'",
    ),
    "many variants": (
        GOOD.replace("scenarios: {", "scenarios: {" + "".join(f"v{i}: [near], " for i in range(20_000))),
        "more than can be checked",
    ),
    "many overrides of many workers": (
        lines("workers", "  w{i}: {{like: ana}}\n", 10_000).replace(
            "overrides:\n", "overrides:\n" + "".join(f"  o{i}: {{workers.w{i}.walk: 1 m/s}}\n" for i in range(10_000))
        ),
        "more than can be checked",
    ),
    "many variants of many workers": (
        (GOOD + "workforce: {n: 500}\n").replace(
            "scenarios: {", "scenarios: {" + "".join(f"v{i}: [near], " for i in range(2_000))
        ),
        "more than can be checked",
    ),
    "unknown overrides": (GOOD.replace("near: [near]", f"near: [{'x, ' * 30_000}x]"), "no override 'x'"),
    "a long chain of likes": (lines("workers", "  w{i}: {{like: w{j}}}\n", 5_000), "no 'w5000' among the workers"),
    "likes of nobody": (lines("workers", "  w{i}: {{like: v{i}}}\n", 10_000), "no 'v0' among the workers"),
    "a name of megabytes": (GOOD.replace("One bench", "x" * 7_000_000), "at most 200 characters"),
    "a number of megabytes": (GOOD.replace("seed: 7", "seed: " + "9" * 5_000_000), "expected a whole number"),
    "a time of megabytes": (GOOD.replace("3 s", "1 s " * 1_500_000), "as a time"),
    "a route round and round": (
        lines("stations", "  s{i}: {{at: bench, tasks: [lift]}}\n", 2000)
        .replace("load: 6 kg", "automatic: true")
        .replace(
            "route: [pack]",
            "routing: {start: s0, " + ", ".join(f"s{i}: {{s{i + 1}: 1}}" for i in range(1999)) + ", s1999: s0}",
        ),
        "no job ever gets out",
    ),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused_before_it_costs_much(name):
    text, said = HOSTILE[name]
    raw = text.encode()
    start = time.process_time()
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(raw, Path("line.yaml"))
    assert said in str(caught.value)
    assert time.process_time() - start < 10  # a square law would take minutes


def test_what_would_steer_a_terminal_is_never_printed():
    text = GOOD.replace("One bench", '"\\e[2J"').replace("  ben:", '  "b\\e]0;x\\a":').replace("[pack]", '["\\x9b31m"]')
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("line.yaml"))
    assert len(caught.value.problems) >= 3
    assert all(character.isprintable() or character == "\n" for character in str(caught.value))
