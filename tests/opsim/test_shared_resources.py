"""Tools and parts of a floor that are resources of somebody's own SimPy model."""

import numpy as np
import pytest
import simpy

from opsim import Floor, audit, compile_plan, figures, read_scenarios, run_plan
from opsim.log import CREATE, FINISH, JOIN, TOOL
from opsim.shipped import shipped_folder

GRID_S = 2**-20
"""The floor's clock goes in steps; our own does not."""
BENCHES = """
opsim: 1
name: Benches and a crane
run: {horizon: 1 h, seed: 1}
layout: {places: {here: [0 m, 0 m]}}
tools: {crane: {n: 1}}
tasks: {lift: {fixed: 30 s, needs: {crane: 1}}}
stations: {bench: {at: here, tasks: [lift], buffer: 2}}
products: {box: {route: [bench]}}
release: {kind: saturated}
workers: {ann: {skills: {bench: 1}}}
outputs: [throughput_per_h]
"""
CARTS = """
opsim: 1
name: Wheels from outside
run: {horizon: 1 h, seed: 1}
layout: {places: {bench: [0 m, 0 m], rack: [1 m, 0 m]}}
tasks: {mount: {fixed: 20 s}}
stations: {assembly: {at: bench, tasks: [mount], buffer: 2}}
stores: {wheels: {at: rack}}
products: {cart: {route: [assembly], parts: {assembly: {wheel: 4}}}, wheel: {route: [wheels]}}
sources:
  carts: {kind: saturated, products: [cart]}
  wheels: {kind: base_stock, store: wheels, level: 0, products: [wheel]}
workers: {ann: {skills: {assembly: 1}}}
outputs: [throughput_per_h]
"""


def planned(tmp_path, text):
    path = tmp_path / "floor.yaml"
    path.write_text(text)
    return compile_plan(read_scenarios(path)["base"])


@pytest.fixture(scope="module")
def guns():
    return compile_plan(read_scenarios(shipped_folder() / "torque_guns.yaml")["base"])


def uses(env, source, use_s, pause_s, had):
    """Takes one, keeps it, gives it back, does without it: again and again."""
    while True:
        if isinstance(source, simpy.Container):
            yield source.get(1)
        else:
            asked = source.request()
            yield asked
        begin_s = env.now
        yield env.timeout(use_s)
        had.append((begin_s, env.now))
        yield source.put(1) if isinstance(source, simpy.Container) else source.release(asked)
        yield env.timeout(pause_s)


def crane(env, kind):
    return simpy.Container(env, capacity=1, init=1) if kind is simpy.Container else kind(env)


@pytest.mark.parametrize("kind", [simpy.Resource, simpy.PriorityResource, simpy.Container])
@pytest.mark.parametrize("start_s", [0.0, 777.0])
def test_two_who_want_one_crane_all_the_time_have_it_in_turn(tmp_path, kind, start_s):
    plan = planned(tmp_path, BENCHES)
    env, had = simpy.Environment(initial_time=start_s), []
    shared = crane(env, kind)
    floor = Floor(env, plan, tools={"crane": shared})
    env.process(uses(env, shared, 20.0, 0.0, had))
    env.run(until=start_s + 1000)
    lifts = floor.log().of(FINISH)["end_s"]
    mine = np.array(had) - start_s
    turn_s = mine[1, 0] - mine[0, 0]
    assert turn_s == 50.0 and np.all(np.diff(mine[:, 0]) == turn_s) and np.all(np.diff(lifts) == turn_s)
    assert np.all((lifts - 30.0 >= mine[: len(lifts), 1].min() - 50.0) & (len(lifts) in (19, 20)))
    assert not any(a < end_s and end_s - 30.0 < b for end_s in lifts for a, b in mine)


def test_a_tool_that_nobody_else_wants_is_as_good_as_ones_own(guns):
    env = simpy.Environment(initial_time=100)
    gun, fixtures = simpy.Resource(env, 1), simpy.Container(env, 3, init=3)
    floor = Floor(env, guns, tools={"torque_gun": gun, "fixture": fixtures})
    env.run()
    log, alone = floor.log(), run_plan(guns)
    assert [f.value for f in figures(log, guns)] == pytest.approx([f.value for f in figures(alone, guns)], nan_ok=True)
    for kind in (FINISH, TOOL):  # work that waits for no time at all is two rows
        ours, own = log.of(kind), alone.of(kind)
        assert all(np.array_equal(ours[name], own[name]) for name in ("start_s", "end_s", "job", "station", "task"))
    assert gun.count == 0 and not gun.queue and fixtures.level == 3


@pytest.mark.parametrize("seed", range(5))
def test_a_gun_is_never_in_two_hands_and_all_laws_hold(guns, seed):
    rng = np.random.default_rng(seed)
    env, had = simpy.Environment(), []
    gun = simpy.Resource(env, 1)
    floor = Floor(env, guns, replication=seed, tools={"torque_gun": gun})
    for _ in range(2):
        env.process(uses(env, gun, rng.uniform(5, 40), rng.uniform(0, 60), had))
    at_s = float(rng.uniform(100, 3000))
    env.run(until=at_s)
    assert audit(floor.log(), floor.plan_so_far())
    env.run(until=floor.ended)
    log = floor.log()
    assert audit(log, guns) and len(had) > 10
    held = log.of(TOOL)
    held = held.where(held["task"] >= 0)  # a fixture is the station's
    all_s = np.array([*zip(held["start_s"], held["end_s"]), *had])
    all_s = all_s[all_s[:, 1] > all_s[:, 0]]
    all_s = all_s[np.argsort(all_s[:, 0])]
    assert len(all_s) > len(had) and np.all(all_s[1:, 0] >= all_s[:-1, 1] - GRID_S)
    alone = run_plan(guns, seed)
    assert len(log.of(FINISH)) < len(alone.of(FINISH))


def test_two_floors_share_a_tool(tmp_path):
    plan = planned(tmp_path, BENCHES)
    env = simpy.Environment()
    shared = simpy.Resource(env)
    floors = [Floor(env, plan, tools={"crane": shared}) for _ in range(2)]
    env.run(until=3001)
    made = [len(floor.log().of(FINISH)) for floor in floors]
    assert sum(made) == 100 and abs(made[0] - made[1]) <= 1


def test_carts_are_made_as_their_wheels_come(tmp_path):
    plan = planned(tmp_path, CARTS)
    env = simpy.Environment()
    box = simpy.Container(env, init=6)
    floor = Floor(env, plan, parts={"wheel": box})

    def supplier():
        for at_s in (100.0, 200.0, 300.0):
            yield env.timeout(at_s - env.now)
            yield box.put(5)

    env.process(supplier())
    env.run()
    assert floor.log().of(FINISH)["end_s"].tolist() == [20.0, 120.0, 220.0, 240.0, 320.0]
    assert audit(floor.log(), plan)


def test_a_store_is_filled_to_its_level_and_no_further(tmp_path):
    plan = planned(tmp_path, CARTS.replace("level: 0", "level: 7").replace("wheel: 4", "wheel: 1"))
    env = simpy.Environment()
    box = simpy.Container(env, init=1000)
    floor = Floor(env, plan, parts={"wheel": box})
    env.run(until=1010)
    alone = Floor(simpy.Environment(), plan)
    alone.env.run(until=1010)
    counts = [[len(one.log().of(kind)) for kind in (CREATE, FINISH, JOIN)] for one in (floor, alone)]
    assert counts[0] == counts[1] and counts[0][1] == 50
    assert 1000 - box.level == 50 + 7 + 3  # for those in line and at work too


def other(env):
    return simpy.Environment()


@pytest.mark.parametrize(
    ("shared", "error", "words"),
    [
        (
            lambda env: {"tools": {"crain": simpy.Resource(env)}},
            ValueError,
            "tools: crain: the scenario has no such tool",
        ),
        (lambda env: {"tools": {"crane": 7}}, TypeError, "tools: crane: expected a simpy.Resource .* found 7"),
        (lambda env: {"tools": {"crane": simpy.PreemptiveResource(env)}}, TypeError, "that is not preemptive"),
        (lambda env: {"tools": {"crane": simpy.Resource(other(env))}}, ValueError, "belongs to another environment"),
        (
            lambda env: {"parts": {"cart": simpy.Container(env)}},
            ValueError,
            "parts: cart: no source of kind base_stock",
        ),
        (lambda env: {"parts": {"box": simpy.Store(env)}}, ValueError, "parts: box: no source of kind base_stock"),
    ],
)
def test_what_cannot_be_shared_is_named(tmp_path, shared, error, words):
    env = simpy.Environment()
    with pytest.raises(error, match=words):
        Floor(env, planned(tmp_path, BENCHES), **shared(env))


def test_a_resource_smaller_than_the_scenarios_number_is_refused(guns):
    env = simpy.Environment()
    with pytest.raises(ValueError, match="the scenario has 3 of it, your resource has room for 2"):
        Floor(env, guns, tools={"fixture": simpy.Resource(env, 2)})


def test_a_container_in_which_no_lot_has_room_is_refused(tmp_path):
    env = simpy.Environment()
    plan = planned(tmp_path, CARTS.replace("wheel: {route: [wheels]}", "wheel: {lot: 8, route: [wheels]}"))
    with pytest.raises(ValueError, match="a lot is 8 pieces, your container holds 5 at most"):
        Floor(env, plan, parts={"wheel": simpy.Container(env, capacity=5)})


def test_parts_out_of_what_is_no_container_are_refused(tmp_path):
    env = simpy.Environment()
    with pytest.raises(TypeError, match=r"parts: wheel: expected a simpy.Container, found <"):
        Floor(env, planned(tmp_path, CARTS), parts={"wheel": simpy.Store(env)})
