import subprocess
import sys

import pytest

from emulator import covariates


@pytest.mark.parametrize("name", covariates.__all__)
def test_every_name_of_the_contents_is_there(name):
    assert getattr(covariates, name) is not None


def test_an_unknown_name_is_refused_with_the_contents():
    with pytest.raises(AttributeError, match=r"emulator.covariates has no 'Boddy'; it has .*Body"):
        _ = covariates.Boddy


def test_importing_loads_no_numpy():
    code = "import sys, emulator.covariates; print(sorted({'numpy', 'scipy'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
