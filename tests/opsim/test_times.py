import re
from hashlib import blake2b
from math import expm1, log, log1p, sqrt

import numpy as np
import pytest
from human_plans import LINE, planned, shipped
from hypothesis import given
from hypothesis import strategies as st

from opsim.clock import DAY_S, TICKS_PER_S, WEEK_S, clock_words, moment_s, on_grid, ticks
from opsim.engine.draws import Draws
from opsim.history import drawn_s
from opsim.streams import BLOCK, Items, stream
from opsim.task_model import log_variance, within_cv


def test_a_delay_is_at_least_one_tick():
    assert on_grid(0.0) == on_grid(1e-12) == 2.0**-20


@given(st.lists(st.floats(1e-3, 1e6), min_size=1, max_size=50))
def test_sums_on_the_grid_are_exact_in_any_order(delays):
    grid = [on_grid(delay) for delay in delays]
    assert sum(grid) == sum(reversed(grid)) == sum(ticks(grid).tolist()) / TICKS_PER_S


@given(st.floats(1e-3, 1e6))
def test_rounding_moves_a_delay_by_half_a_tick_at_most(delay):
    assert abs(on_grid(delay) - delay) <= 0.5 / TICKS_PER_S


MON_6, H = 6 * 3600.0, 3600.0


def test_days_may_be_written_out_and_clocks_have_seconds():
    assert moment_s("monday 06:00:30", MON_6) == moment_s("MON 6:00:30", MON_6) == 30.0
    assert moment_s("06:00:30.5", MON_6) == 30.5


def test_a_clock_before_the_start_is_that_of_the_next_week():
    assert moment_s("Mon 05:00", MON_6) == WEEK_S - H


@given(st.integers(0, 6 * 86400), st.integers(0, int(WEEK_S) - 1))
def test_the_words_of_a_moment_are_read_as_that_moment(start_s, at_s):
    assert moment_s(clock_words(at_s, start_s), start_s) == at_s


@given(st.floats(0, WEEK_S), st.floats(0, 3 * DAY_S), st.integers(0, 23), st.integers(0, 59))
def test_a_clock_of_the_day_is_at_most_a_day_away(start_s, after_s, hour, minute):
    found_s = moment_s(f"{hour}:{minute:02d}", start_s, after_s)
    assert 0 <= found_s - after_s <= DAY_S + 1e-6
    apart_s = (start_s + found_s - hour * H - minute * 60) % DAY_S
    assert min(apart_s, DAY_S - apart_s) < 1e-3


def test_a_moment_is_said_as_a_scenario_says_it():
    assert clock_words(30 * H) == "Tue 06:00" and clock_words(24 * H + 65, MON_6) == "Tue 06:01:05"
    assert clock_words(7 * DAY_S + 0.2) == "Mon 00:00" and clock_words(DAY_S - 0.1) == "Tue 00:00"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("99:15", "cannot read '99:15' as a clock; write 'Mon 07:30' or '07:30'"),
        ("24:00", "cannot read '24:00'"),
        ("06:60", "cannot read '06:60'"),
        ("06:00:60", "cannot read '06:00:60'"),
        ("Monkey 06:15", "no weekday 'Monkey'; did you mean 'Monday'?"),
        ("Tus 06:00", "no weekday 'Tus'; did you mean 'Tue'?"),
        ("soon", "cannot read 'soon' as a time; write '2 h' or a clock, 'Mon 07:30'"),
        ("90", "has no unit"),
        ("", "write '2 h' or a clock"),
    ],
)
def test_what_is_no_moment_is_refused_in_words(text, said):
    with pytest.raises(ValueError) as refused:
        moment_s(text, MON_6)
    assert said in str(refused.value)


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


CVS, SHARES = st.floats(1e-3, 10), st.floats(0, 1)


@given(CVS, SHARES)
def test_between_and_within_give_back_the_cv(cv, share):
    between_cv2 = expm1(share * log_variance(cv))
    assert (1 + between_cv2) * (1 + within_cv(cv, share) ** 2) == pytest.approx(1 + cv**2, rel=1e-12)


@given(CVS, SHARES)
def test_for_lognormal_times_the_share_is_that_of_the_variance_of_log_time(cv, share):
    assert log1p(within_cv(cv, share) ** 2) == pytest.approx((1 - share) * log_variance(cv), rel=1e-9, abs=1e-15)


def test_known_values():
    assert within_cv(0.3, 0.0) == 0.3
    assert within_cv(0.3, 1.0) == 0.0
    assert log_variance(1.0) == pytest.approx(log(2))
    assert within_cv(1.0, 0.5) == pytest.approx(sqrt(sqrt(2) - 1))


@pytest.mark.parametrize("k", [[0], [63, 64, 65], [200, 3, 3, 130], []])
def test_what_was_drawn_is_what_the_engine_draws(k):
    plan = planned(LINE.replace("cv: 0.25}", "cv: 0.25, between_share: 0.5}"))
    engine = Draws(plan, 2)
    expected = [engine.duration_s(1, 2, one) for one in k]
    assert drawn_s(plan, 2, 2, 1, np.array(k, dtype=np.int64)).tolist() == expected


@pytest.mark.slow
def test_recorded_movements_are_drawn_again_to_the_bit():
    plan = shipped("low_pallet", 1.0)
    engine, task = Draws(plan, 1), next(at for at, one in enumerate(plan.tasks) if one.handling.load_kg)
    assert drawn_s(plan, 1, 0, task, np.arange(70)).tolist() == [engine.duration_s(task, 0, k) for k in range(70)]
