"""The house: who may import whom, no cycles, nothing heavy at the door."""

import ast
import subprocess
import sys
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FORBIDDEN = {
    "emulator": {"opsim", "simpy", "yaml", "pydantic", "click", "rich", "duckdb", "matplotlib"},
    "opsim": {"emulator", "matplotlib", "numba"},
}
MAY_MEET_THE_EMULATOR = ("opsim/cli/", "opsim/libraries.py")
COMPILED = ("opsim/ergonomics/kernels/", "opsim/engine/fast_engine/")
"""Imported inside functions only, so numba may stand at the top there."""

LAYERS = (
    "units problems clock streams files log log_parquet shipped libraries results csv_input threads pool checkup "
    "task_model performance worker_effects engine.rules kpi.catalogue",
    "plugins",
    "scenario plan tasks human ergonomics kpi laws subjects layout history external_draws external_log external_worker",
    "engine export fitting",
    "floor study",
    "report",
    "viewer notebook cli",
)
"""Modules and packages of opsim: what stands lower knows nothing of what stands above it; the foot first."""


@cache
def modules(package: str) -> dict[str, Path]:
    def name(path: Path) -> str:
        parts = path.relative_to(ROOT).with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    return {name(path): path for path in sorted((ROOT / package).rglob("*.py"))}


RULES = {name for name, path in modules("opsim").items() if ".subjects." in name and "engine.floor" in path.read_text()}
"""Files of subjects that are rules of the floor: those that name it."""


@dataclass(frozen=True)
class Imports:
    """What a file imports, by full names: at its top level; everywhere, inside functions, too; and what it takes from
    where (``from a import b`` is a.b) at its top level or for type checkers. Imports for these count only there.

    outside_methods : what it takes from where, all but what methods of its classes import
    """

    top: frozenset[str]
    everywhere: frozenset[str]
    taken: frozenset[str]
    outside_methods: frozenset[str]


@cache
def imports_of(path: Path) -> Imports:
    """The tree itself is not kept: the collector of garbage would go through its nodes again and again."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    typed = [
        node
        for one in tree.body
        if isinstance(one, ast.If) and "TYPE_CHECKING" in ast.dump(one.test)
        for node in one.body
    ]
    plain, taken = names_in(tree.body)
    methods = {id(node) for one in ast.walk(tree) if isinstance(one, ast.ClassDef) for node in ast.walk(one)}
    _, outside = names_in(node for node in ast.walk(tree) if id(node) not in methods)
    everywhere = frozenset().union(*names_in(ast.walk(tree)))
    return Imports(plain | taken, everywhere, taken | names_in(typed)[1], outside)


def names_in(nodes: Iterable[ast.AST]) -> tuple[frozenset[str], frozenset[str]]:
    """Modules that these nodes import, and a.b for each ``from a import b``."""
    modules, taken = set(), set()
    for node in nodes:
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            modules.add(node.module)
            taken |= {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(modules), frozenset(taken)


def top(names: frozenset[str]) -> set[str]:
    return {name.partition(".")[0] for name in names}


@pytest.mark.parametrize("package", FORBIDDEN)
def test_dependence_points_one_way(package):
    broken = [
        f"{path.relative_to(ROOT)}: imports {name}"
        for path in modules(package).values()
        for name in top(imports_of(path).top) & FORBIDDEN[package]
        if name != "numba" or not path.relative_to(ROOT).as_posix().startswith(COMPILED)
    ]
    assert not broken, broken


def test_the_emulator_knows_nothing_of_opsim_even_inside_functions():
    broken = [path for path in modules("emulator").values() if "opsim" in top(imports_of(path).everywhere)]
    assert not broken, broken


def test_opsim_meets_the_emulator_only_at_its_two_doors():
    meeting = [
        path.relative_to(ROOT).as_posix()
        for path in modules("opsim").values()
        if "emulator" in top(imports_of(path).everywhere)
    ]
    assert meeting and all(path.startswith(MAY_MEET_THE_EMULATOR) for path in meeting), meeting


def test_rules_are_plain_arithmetic():
    path = ROOT / "opsim/engine/rules.py"
    assert not imports_of(path).everywhere
    tree = ast.parse(path.read_text(encoding="utf-8"))
    calls = {one.func.id for one in ast.walk(tree) if isinstance(one, ast.Call) and isinstance(one.func, ast.Name)}
    assert calls <= {"min", "max", "range"}, calls


@pytest.mark.parametrize("package", FORBIDDEN)
def test_no_import_cycles(package):
    """Imports inside functions and for type checkers count; but a method may call what makes, keeps or shows its
    type, such as ``MotionEmulator.fit``."""
    known = modules(package)
    graph = {name: known_of(imports_of(path).outside_methods, known) - {name} for name, path in known.items()}
    done: set[str] = set()
    for start in graph:
        _visit(start, graph, [], done)


def layer_of(module: str) -> int:
    """The place in LAYERS of the longest beginning that is named there; a subject's rules stand with the floor."""
    places = {name: place for place, names in enumerate(LAYERS) for name in names.split()}
    if module in RULES:
        return places["engine"]
    parts = module.split(".")[1:]
    return next(places[name] for n in range(len(parts), 0, -1) if (name := ".".join(parts[:n])) in places)


def test_imports_of_opsim_go_down_only():
    """Within a layer as well as below it; inside functions they are free."""
    known = {name: path for name, path in modules("opsim").items() if name not in ("opsim", "opsim.__main__")}
    up = [
        f"{name} imports {other}"
        for name, path in known.items()
        for other in needed(path, known)
        if layer_of(other) > layer_of(name)
    ]
    assert not up, up


KINDS = {"words": 0, "plan": 1} | dict.fromkeys(("checks", "warnings", "assumptions", "figures", "laws"), 2)
"""Files of a subject by their names: what each may know of the others, its own subject's or another's."""


def test_files_of_subjects_know_only_kinds_below_theirs():
    known = {name: path for name, path in modules("opsim").items() if ".subjects." in name}
    up = [
        f"{name} imports {other}"
        for name, path in known.items()
        for other in needed(path, known)
        if KINDS.get(other.rpartition(".")[2], 0) > KINDS.get(name.rpartition(".")[2], 9)
    ]
    assert not up, up


def needed(path: Path, known: Collection[str]) -> set[str]:
    """The modules that a file imports at its top level or for type checkers; ``from a import b`` needs a.b."""
    return known_of(imports_of(path).taken, known)


def known_of(taken: Iterable[str], known: Collection[str]) -> set[str]:
    """The modules, of those known, that names are taken from."""
    return {name if name in known else name.rpartition(".")[0] for name in taken} & set(known)


def _visit(name: str, graph: dict[str, set[str]], trail: list[str], done: set[str]) -> None:
    # A package's __init__ is its table of contents: importing a sibling passes through it, which Python allows.
    assert name not in trail, f"import cycle: {' -> '.join([*trail[trail.index(name) :], name])}"
    if name in done:
        return
    for target in sorted(graph[name]):
        _visit(target, graph, [*trail, name], done)
    done.add(name)


@pytest.mark.parametrize(
    ("statement", "absent"),
    [
        ("import opsim", {"numpy", "simpy", "pydantic"}),
        ("from opsim import Floor, Worker", {"pydantic", "yaml", "scipy", "numba", "duckdb", "emulator"}),
        ("import emulator", {"numpy", "numba"}),
        ("import emulator.model.library", {"numba", "scipy"}),
        ("import opsim.cli.check, opsim.cli.run, opsim.cli.study_options", {"numpy", "yaml", "pydantic", "rich"}),
        ("import opsim.scenario.read", {"numpy", "numba", "matplotlib", "emulator"}),
        (
            "import opsim.plan.compile, opsim.tasks, opsim.plan.warnings",
            {"numpy", "simpy", "scipy", "matplotlib", "emulator"},
        ),
        ("import opsim.engine.floor.run", {"numba", "matplotlib", "scipy", "emulator"}),
    ],
)
def test_importing_is_light(statement, absent):
    code = f"import sys; {statement}; print(*sys.modules)"
    loaded = set(
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    )
    assert not absent & loaded


def test_no_file_holds_more_than_a_page_or_two():
    long = {
        str(path): n
        for package in FORBIDDEN
        for path in modules(package).values()
        if (n := len(path.read_text().splitlines())) > 400
    }
    assert not long, long
