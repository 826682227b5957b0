"""What the offline pages run, opsim/viewer/assets, is what its source beside it is built into, byte for byte."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

VIEWER = Path(__file__).parent.parent / "opsim" / "viewer"
SOURCE, ASSETS = VIEWER / "page", VIEWER / "assets"
NOT_COPIED = shutil.ignore_patterns("node_modules")


@pytest.fixture(scope="module")
def npm():
    """npm; without it the tests are skipped, or fail where the environment says CI."""
    found = shutil.which("npm") and shutil.which("node")
    if not found:
        (pytest.fail if os.environ.get("CI") else pytest.skip)("no node and npm found: apt-get install nodejs npm")
    return shutil.which("npm")


@pytest.fixture(scope="module")
def built(npm, tmp_path_factory):
    """The assets as they are built from a copy of the source, with the packages that the lock file names."""
    viewer = tmp_path_factory.mktemp("viewer")
    shutil.copytree(SOURCE, viewer / "page", ignore=NOT_COPIED)
    (viewer / "assets").mkdir()
    for words in (["ci", "--no-audit", "--no-fund"], ["run", "build"]):
        done = subprocess.run([npm, *words], cwd=viewer / "page", capture_output=True, text=True)
        if done.returncode and words[0] == "ci" and not os.environ.get("CI"):
            pytest.skip(f"npm ci did not get the packages: {done.stderr[-300:]}")
        assert done.returncode == 0, done.stderr
    return {path.name: path.read_bytes() for path in (viewer / "assets").iterdir()}


@pytest.mark.slow
def test_the_committed_assets_are_what_their_source_is_built_into(built):
    assert {*built} == {path.name for path in ASSETS.iterdir()}
    others = [name for name, content in built.items() if content != (ASSETS / name).read_bytes()]
    assert not others, "built otherwise: run 'make page' and commit what it writes"


def test_the_lock_file_names_no_host_and_every_package_by_its_content():
    lock = (SOURCE / "package-lock.json").read_text(encoding="utf-8")
    assert "://" not in lock and '"resolved"' not in lock
    assert lock.count('"integrity": "sha512-') == lock.count('"node_modules/')


def test_the_script_names_whose_code_is_in_it_and_the_licence_lies_beside_it():
    """three.js (MIT) alone is shipped; esbuild and axe-core are tools and stay here."""
    assert (ASSETS / "replay.min.js").read_text(encoding="utf-8").startswith("/* three.js: MIT, see three.LICENSE.txt.")
    assert "MIT License" in (ASSETS / "three.LICENSE.txt").read_text(encoding="utf-8")
