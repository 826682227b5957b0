import socket

import pytest

from opsim.study.jobs.executors import executor_of


@pytest.mark.parametrize("address", ["nowhere", "tcp://", "host:0", "host:99999", "tcp://a b:1", "http://host:8786"])
def test_what_is_no_address_is_refused_with_what_is_expected(address):
    with pytest.raises(ValueError, match="expected dask:tcp://HOST:PORT"), executor_of(f"dask:{address}"):
        pass


def test_somebody_who_is_no_scheduler_is_not_waited_for_for_ever(monkeypatch):
    monkeypatch.setattr("opsim.study.jobs.executors.CONNECT_S", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"dask:tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(OSError, match="no scheduler answers there"), executor_of(address):
            pass


def test_without_dask_it_is_said_how_to_get_it(monkeypatch):
    monkeypatch.setattr("opsim.study.jobs.executors.find_spec", lambda name: None)
    with pytest.raises(ValueError, match=r"pip install opsim\[cluster\]"), executor_of("dask:tcp://127.0.0.1:1"):
        pass


def test_no_executor_is_this_machine():
    with executor_of(None) as executor:
        assert executor is None
