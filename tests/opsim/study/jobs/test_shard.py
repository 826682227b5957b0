import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.study.jobs.job import Shard


@given(st.integers(1, 40), st.integers(0, 200))
def test_shards_share_out_all_jobs_and_none_twice(of, n):
    jobs = list(range(n))
    parts = [Shard(number, of).takes(jobs) for number in range(1, of + 1)]
    assert sorted(job for part in parts for job in part) == jobs
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


@given(st.integers(1, 99), st.integers(1, 99))
def test_a_shard_is_known_by_its_words_and_its_file(a, b):
    shard = Shard(min(a, b), max(a, b))
    assert Shard.read(f" {shard} ") == shard == Shard.of_file(shard.file)


@pytest.mark.parametrize(
    "text", ["9/8", "0/8", "1/0", "x", "", "1/2/3", "-1/2", "1.5/2", "1/", "9" * 50 + "/3", "2/9999999"]
)
def test_a_shard_that_is_none_is_refused_with_what_is_expected(text):
    with pytest.raises(ValueError, match="--shard"):
        Shard.read(text)


def test_the_journal_of_a_whole_study_is_no_shard():
    assert Shard.of_file("all.jsonl") is None
