from opsim.viewer.build import notes_of

MADE = {"source": "synthetic reach", "licence": "MIT", "n_sequences": 10, "n_workers": 4, "library": "b.npz"}


def task(name, **more):
    return {"task": name, "emulated": False, "automatic": False, **more}


def emulated(name, learned, **more):
    return task(name, **{**MADE, "emulated": True, "library_task": learned, **more})


def said(*tasks, walking=None, seed=3, **others):
    summaries = {"base": {"seed": seed, "tasks": list(tasks), **({} if walking is None else {"walking": walking})}}
    return dict(notes_of(summaries | others, 2))


def test_one_replication_is_not_taken_for_the_average():
    assert said()["Run"] == "replication 2, seed 3: one course of luck, not the average"


def test_a_source_is_named_once_with_all_that_was_learned_from_it():
    words = said(emulated("take", "reach"), emulated("give", "reach"), emulated("bend", "stoop"))["Movements"]
    assert words.endswith("from synthetic reach (20 made repetitions of 4 made-up people: nobody was recorded)")


def test_walking_and_its_licence_stand_beside_the_tasks():
    walk = {**MADE, "source": "KIT", "licence": "CC", "n_sequences": 5, "n_workers": 2, "library_task": "walk"}
    found = said(emulated("take", "reach"), walking=walk)
    assert "KIT (5 recordings of 2 people)" in found["Movements"] and found["Licences"] == "MIT; CC"


def test_times_without_a_body_are_named_and_machines_are_not_people():
    found = said(task("label"), task("cut", automatic=True), emulated("take", "reach"))
    assert found["Without movement"].startswith("label: ")


def test_nothing_is_said_of_what_is_not_there():
    assert set(said(task("cut", automatic=True))) == {"Run", "Licences"}


def test_what_two_variants_share_is_said_once():
    other = {"seed": 3, "tasks": [emulated("take", "reach"), task("label")]}
    found = said(emulated("take", "reach"), task("label"), near=other)
    assert found["Without movement"].startswith("label: ") and found["Movements"].count("synthetic") == 1
