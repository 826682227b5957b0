from pathlib import Path

from opsim.export.tables import out_for


def test_of_several_files_each_has_its_variant_and_replication_before_the_ending():
    out = Path("some/log.jsonocel")
    assert out_for(out) == out
    assert out_for(out, variant="near") == Path("some/log_near.jsonocel")
    assert out_for(out, variant="near", replication=12) == Path("some/log_near_r00012.jsonocel")
