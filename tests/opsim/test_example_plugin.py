"""The example plug-in, installed by pip into an environment of its own that sees our packages; no network."""

import json
import re
import shutil
import site
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples" / "opsim_example_plugin"


class Installed:
    """A fresh environment with the example plug-in in it."""

    def __init__(self, folder):
        self.folder = folder / "environment"
        venv.create(self.folder, with_pip=False, symlinks=True)
        self.python = next(self.folder.glob("*/python"))
        self.packages = next(self.folder.glob("lib/*/site-packages"))
        ours = [str(ROOT), *site.getsitepackages()]
        (self.packages / "ours.pth").write_text("".join(f"import site; site.addsitedir({path!r})\n" for path in ours))
        shutil.copytree(EXAMPLE, folder / "source")
        self.pip("install", "--no-index", "--no-deps", "--no-build-isolation", str(folder / "source"))

    def pip(self, *words):
        command = [sys.executable, "-m", "pip", "--python", str(self.python), "--quiet", "--disable-pip-version-check"]
        subprocess.run([*command, *words], check=True)

    def run(self, code, *, expect=0):
        """What a script prints in the environment; on an error, what it says there."""
        done = subprocess.run([self.python, "-c", code], capture_output=True, text=True, cwd=self.folder)
        assert done.returncode == expect, done.stderr
        return done.stdout if expect == 0 else done.stderr

    def opsim(self, verb, scenario, *words):
        """Exit code and all that ``opsim VERB`` says of a scenario."""
        (self.folder / "scenario.yaml").write_text(scenario)
        command = [self.python, "-c", "from opsim.cli import main; main()", verb, "scenario.yaml", *words]
        done = subprocess.run(command, capture_output=True, text=True, cwd=self.folder)
        return done.returncode, done.stdout + done.stderr

    def broken(self, file, old, new):
        """The file of the installed plug-in with a line changed; a function that mends it again."""
        path = self.packages / "opsim_example_plugin" / file
        right = path.read_text()
        assert old in right
        path.write_text(right.replace(old, new))
        return lambda: path.write_text(right)


@pytest.fixture(scope="module")
def found_and_done(installed):
    """What the scripts below print of what is found (three lines), and of work that is done (the last)."""
    return installed.run(FOUND + WORK).splitlines()


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    return Installed(tmp_path_factory.mktemp("plugin"))


FOUND = """
from opsim.plugins import plugins
for group in ("opsim.emulators", "opsim.dispatch", "opsim.subjects"):
    print(*(plugins(group).found(name) for name in plugins(group) if not plugins(group).found(name).is_ours))
"""
WORK = """
import json, simpy
from opsim import Worker
from opsim.plugins import plugin_model
pick = plugin_model("mtm1_get_and_place", {"reach": "12 in", "move": "18 in", "grasp": "1B", "cv": 0.1})
env = simpy.Environment()
ana = Worker(env, "ana", {"pick": pick})
done = [env.run(ana.perform("pick")) for _ in range(500)]
print(json.dumps([pick.mean_duration_s(), sum(p.duration_s for p in done) / 500, done[0].mark_s, done[0].duration_s]))
"""
SCENARIO = """
opsim: 1
name: Picking
run: {horizon: 1 h, replications: 2, seed: 1}
layout: {places: {rack: [0 m, 0 m], bench: [5 m, 0 m]}}
tasks:
  pick: {plugin: mtm1_get_and_place, with: {reach: 12 in, move: 18 in, grasp: 1B, cv: 0.1}, repeat: 3}
  label: {fixed: 4 s}
stations: {rack: {at: rack, tasks: [pick], buffer: 2}, bench: {at: bench, tasks: [label], buffer: 2}}
products: {order: {route: [rack, bench]}}
release: {kind: saturated}
workers: {ana: {skills: {rack: 1.0, bench: 0.9}}, ben: {skills: {rack: 0.9, bench: 1.1}}}
allocation: {rule: spare_the_best}
"""
FROM_THE_COMMAND_LINE = """
import sys, types, click, numpy
from opsim.cli.app import Verbs, mistakes
from opsim.plugins import dispatch_rule, plugin_model
@click.command()
def use():
    with mistakes():
        {code}
sys.modules["use"] = types.SimpleNamespace(command=use)
Verbs("opsim", verbs={{"use": "use"}}).main(["use"])
"""
MAKE = "plugin_model('mtm1_get_and_place', {'reach': '40 cm', 'move': '40 cm'})"
DRAW = f"{MAKE}.sample(64, numpy.random.default_rng())"
CHOOSE = "dispatch_rule('spare_the_best')(1, 0, 0, 1, 0, 0)"


def test_the_installed_example_is_found_with_its_distribution(found_and_done):
    emulators, rules, subjects, _ = found_and_done
    assert subjects == "opsim-example-plugin 0.1.0 (opsim.subjects: cooling = opsim_example_plugin.cooling:COOLING)"
    assert emulators == (
        "opsim-example-plugin 0.1.0 (opsim.emulators: mtm1_get_and_place = opsim_example_plugin.mtm1:GetAndPlace)"
    )
    assert rules == (
        "opsim-example-plugin 0.1.0 "
        "(opsim.dispatch: spare_the_best = opsim_example_plugin.spare_the_best:spare_the_best)"
    )


def test_the_emulator_of_the_example_works_for_a_worker(found_and_done):
    mean_s, mean_drawn_s, marks, duration_s = json.loads(found_and_done[-1])
    assert mean_s == pytest.approx(0.036 * (12.9 + 3.5 + 17.0 + 2.0))
    assert mean_drawn_s == pytest.approx(mean_s, rel=4 * 0.1 / 500**0.5)
    shares = [mark / duration_s for mark in marks]
    assert shares == pytest.approx([12.9 / 35.4, 16.4 / 35.4, 33.4 / 35.4], abs=1e-6)


def test_a_scenario_names_the_example_and_its_results_say_which_version_it_was(installed):
    code, said = installed.opsim("run", SCENARIO, "-o", "out", "--processes", "1")
    assert code == 0 and "Work a job gets at the station" in said
    manifest = json.loads((installed.folder / "out" / "base" / "manifest.json").read_text())
    assert manifest["plugins"] == dict.fromkeys(["spare_the_best", "mtm1_get_and_place"], "opsim-example-plugin 0.1.0")
    summary = json.loads((installed.folder / "out" / "base" / "summary.json").read_text())
    pick = next(row for row in summary["kpis"] if (row["kpi"], row["subject"]) == ("duration_s", "pick"))
    by_the_slower = 0.036 * (12.9 + 3.5 + 17.0 + 2.0) / 0.9
    assert pick["mean"] == pytest.approx(by_the_slower, rel=0.02)


@pytest.mark.slow
def test_the_scenario_with_the_subject_of_the_example_runs_and_its_results_say_which_version_it_was(installed):
    text = (EXAMPLE / "glue_station.yaml").read_text()
    assert installed.opsim("check", text)[0] == 0
    code, said = installed.opsim("run", text, "-o", "glue")
    assert code == 0 and "Cool-downs of the station" in said
    manifest = json.loads((installed.folder / "glue" / "base" / "manifest.json").read_text())
    assert manifest["plugins"] == {"cooling": "opsim-example-plugin 0.1.0"}
    assert "cool_down: 90 s" in (installed.folder / "glue" / "base" / "report.html").read_text()
    code, said = installed.opsim("run", text, "-o", "fast", "--engine", "fast")
    assert code == 2 and "the subject 'cooling' of opsim.subjects is a plug-in in Python" in said


def test_every_mistake_in_naming_a_plug_in_is_said_at_its_place(installed):
    wrong = SCENARIO.replace("reach: 12 in", "reech: 12 in, reach: 4").replace("spare_the_best", "spare_the_bes")
    code, said = installed.opsim("check", wrong)
    assert code == 2 and "3 problems" in said
    assert "tasks.pick.with.reech: no parameter 'reech'" in said and "did you mean 'reach'?" in said
    assert "tasks.pick.with.reach: 4 has no unit; expected a length" in said
    assert "allocation.rule: no rule 'spare_the_bes'" in said and "did you mean 'spare_the_best'?" in said


@pytest.mark.slow
def test_an_emulator_that_is_not_there_is_said_at_its_place(installed):
    code, said = installed.opsim("check", SCENARIO.replace("mtm1_get", "mtm2_get"))
    assert code == 2 and "tasks.pick.plugin: no plug-in 'mtm2_get_and_place'" in said


@pytest.mark.parametrize("processes", [pytest.param("1", marks=pytest.mark.slow), "2"])
def test_a_plug_in_that_fails_in_the_middle_of_a_run_is_blamed_without_a_traceback_of_ours(processes, installed):
    mend = installed.broken("spare_the_best.py", "+rating", "1 / (n_waiting - n_waiting)")
    try:
        code, said = installed.opsim("run", SCENARIO, "-o", f"blamed{processes}", "--processes", processes)
    finally:
        mend()
    assert code == 2 and "Traceback" not in said
    assert "plug-in 'spare_the_best' of opsim-example-plugin 0.1.0: failed as it chose: ZeroDivisionError" in said
    assert re.search(r"opsim_example_plugin/spare_the_best.py:\d+: return", said)


@pytest.mark.parametrize(
    ("file", "old", "new", "code", "said"),
    [
        ("mtm1.py", "import numpy as np", "import no_such", MAKE, "cannot be imported: ModuleNotFoundError: No module"),
        ("mtm1.py", ".cumsum()", ".no_such()", DRAW, "failed as it drew 64 performances: AttributeError"),
        (
            "spare_the_best.py",
            ", worker_rank):",
            "):",
            "dispatch_rule('spare_the_best')",
            "spare_the_best takes (n_waiting, oldest",
        ),
        (
            "spare_the_best.py",
            "+rating",
            "+rating / 0",
            CHOOSE,
            "failed as it chose: ZeroDivisionError: division by zero",
        ),
    ],
    ids=["import", "use of an emulator", "signature", "use of a rule"],
)
def test_a_mistake_of_the_example_is_reported_as_its_own(file, old, new, code, said, installed):
    mend = installed.broken(file, old, new)
    try:
        complaint = installed.run(FROM_THE_COMMAND_LINE.format(code=code), expect=2)
    finally:
        mend()
    assert said in complaint and "of opsim-example-plugin 0.1.0: " in complaint
    assert re.search(rf"opsim_example_plugin/{file}", complaint) and "entry point opsim." in complaint
    assert "Traceback" not in complaint and "opsim/plugins" not in complaint


def test_what_a_user_gives_the_example_wrongly_is_not_its_mistake(installed):
    complaint = installed.run(FROM_THE_COMMAND_LINE.format(code=MAKE.replace("40 cm", "4 m")), expect=2)
    assert complaint == "plug-in mtm1_get_and_place: reach must be 0.05 to 0.76 m, found 4 m\n"


def test_the_source_of_the_example_is_small_and_declares_what_it_has():
    sources = list((EXAMPLE / "src").rglob("*.py"))
    assert sum(len(path.read_text().splitlines()) for path in sources) < 300
    declared = re.findall(r'= "(opsim_example_plugin\.\w+):(\w+)"', (EXAMPLE / "pyproject.toml").read_text())
    for module, name in declared:
        source = Path(EXAMPLE, "src", *module.split(".")).with_suffix(".py").read_text()
        assert re.search(rf"^((def|class) )?{name}\b", source, re.MULTILINE)
    assert len(declared) == 3
