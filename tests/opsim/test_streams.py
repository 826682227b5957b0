import re
from hashlib import blake2b

import numpy as np
import pytest

from opsim.streams import BLOCK, Items, stream


def normals(rng, _block):
    return rng.standard_normal(BLOCK)


def test_a_stream_is_what_it_always_was():
    assert stream(7, 0, "duration", "lift", "ana", 0).integers(10**9) == 250868333


def test_every_part_of_the_name_counts():
    names = [(7, 0, "a", "b"), (8, 0, "a", "b"), (7, 1, "a", "b"), (7, 0, "ab"), (7, 0, "b", "a"), (7, 0, "a", "b", 0)]
    assert len({stream(*name).integers(2**60) for name in names}) == len(names)


@pytest.mark.parametrize("item", [0, 1, 63, 64, 200])
def test_an_item_drawn_alone_equals_the_item_of_its_block(item):
    alone = Items(3, 2, ("duration", "lift", "ana"), normals)[item]
    in_order = Items(3, 2, ("duration", "lift", "ana"), normals)
    assert [in_order[i] for i in range(item + 1)][-1] == alone


def test_items_can_be_had_again_in_any_order():
    items = Items(3, 2, ("uptime", "press"), normals)
    forward = [items[i] for i in range(300)]
    assert [items[i] for i in reversed(range(300))] == forward[::-1]


def test_items_are_uniform_over_blocks():
    items = Items(1, 0, ("mix", "release"), lambda rng, _b: rng.random(BLOCK))
    values = np.array([items[i] for i in range(64 * 100)])
    assert abs(values.mean() - 0.5) < 4 * np.sqrt(1 / 12 / values.size)
    assert abs(np.corrcoef(values[:-1], values[1:])[0, 1]) < 4 / np.sqrt(values.size)


@pytest.mark.parametrize("seed", [0, 7, 2**32 - 1, 2**32, 2**100, 2**128, 2**200])
@pytest.mark.parametrize("replication", [0, 3, 2**40])
def test_a_stream_is_numpys_own_of_seed_and_spawn_key(seed, replication):
    name = ("duration", "lift", 12)
    hashed = b"".join(blake2b(str(part).encode(), digest_size=8).digest() for part in name)
    sequence = np.random.SeedSequence(seed, spawn_key=(replication, *np.frombuffer(hashed, "<u4").tolist()))
    wanted = np.random.default_rng(sequence).bit_generator.state
    assert stream(seed, replication, *name).bit_generator.state == wanted
    blocks = Items(seed, replication, name[:2], lambda rng, _: rng.bit_generator.state)
    assert blocks.block(12) == wanted


@pytest.mark.parametrize("wrong", [-1, 1.5, "two"])
def test_a_seed_or_replication_that_is_no_whole_number_from_0_is_refused_in_words(wrong):
    said = re.escape(f"found {wrong!r}, expected a whole number from 0")
    for seed, replication in ((wrong, 0), (1, wrong)):
        with pytest.raises(ValueError, match=said):
            stream(seed, replication, "a")


def test_a_number_of_numpys_is_one_of_ours():
    assert stream(np.int64(3), np.int32(2), "a").random() == stream(3, 2, "a").random()
