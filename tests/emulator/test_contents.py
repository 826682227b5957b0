import subprocess
import sys

import numba
import numpy as np
import pytest

import emulator
from emulator import covariates
from emulator.kernels.compiled import compiled


@pytest.mark.parametrize("name", emulator.__all__)
def test_every_name_of_the_contents_is_there(name):
    assert getattr(emulator, name) is not None


def test_an_unknown_name_is_refused_with_the_contents():
    with pytest.raises(AttributeError, match=r"emulator has no 'MotionEmulater'; it has .*MotionEmulator"):
        _ = emulator.MotionEmulater


def test_importing_loads_neither_numpy_nor_numba():
    code = "import sys, emulator; print(sorted({'numpy', 'numba', 'scipy'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_reading_recordings_does_not_load_numba():
    code = "import sys, emulator; emulator.read_motions, emulator.align, emulator.tsrvf; print('numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_kernels_are_compiled_where_no_cache_can_be_written(monkeypatch):
    njit, asked = numba.njit, []

    def without_cache(*function, **options):
        if function:  # numba's own use, bare
            return njit(*function, **options)
        asked.append(options)
        if options.get("cache"):
            raise RuntimeError("cannot cache function 'double': no locator available")
        return njit(**options)

    monkeypatch.setattr(numba, "njit", without_cache)

    @compiled(nogil=True)
    def double(x):
        return 2 * x

    assert np.array_equal(double(np.arange(3.0)), [0, 2, 4])
    assert asked == [{"cache": True, "nogil": True}, {"nogil": True}]


@pytest.mark.parametrize("name", covariates.__all__)
def test_every_name_of_the_contents_is_there_contents(name):
    assert getattr(covariates, name) is not None


def test_an_unknown_name_is_refused_with_the_contents_of_covariates():
    with pytest.raises(AttributeError, match=r"emulator.covariates has no 'Boddy'; it has .*Body"):
        _ = covariates.Boddy


def test_importing_loads_no_numpy():
    code = "import sys, emulator.covariates; print(sorted({'numpy', 'scipy'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
