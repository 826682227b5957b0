from types import SimpleNamespace

import pytest

from opsim.ergonomics.shift.frames import handlings
from opsim.plan.tasks import Handling, Moment

MODELS = {"lift": SimpleNamespace(mark_names=("grasp", "release")), "look": object()}


def test_words_and_a_handling_are_the_same():
    said = Handling(load_kg=8, grip="fair", start=Moment(mark=0), end=Moment(share=0.9))
    words = {"load_kg": 8, "grip": "fair", "start": "grasp", "end": 0.9, "legs": None}
    assert handlings({"lift": words}, MODELS) == handlings({"lift": said}, MODELS) == {"lift": said}
    assert handlings({"lift": {"end": 1}}, MODELS)["lift"] == Handling(end=Moment(share=1.0))


def test_nothing_said_is_nothing():
    assert handlings(None, MODELS) == {} and handlings({"look": {}}, MODELS) == {"look": Handling()}


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ({"lft": {}}, "no task 'lft'; did you mean 'lift'?"),
        ({"lift": 3}, "handling of lift: expected a Handling or its words, found 3"),
        ({"lift": {"load": 8}}, "no 'load'; did you mean 'load_kg'?"),
        ({"lift": {"load_kg": "8 kg"}}, "load_kg: found '8 kg', expected kilograms from 0"),
        ({"lift": {"load_kg": float("nan")}}, "expected kilograms from 0"),
        ({"lift": {"load_kg": True}}, "expected kilograms from 0"),
        ({"lift": Handling(grip="fiar")}, "grip: no 'fiar'; did you mean 'fair'?"),
        ({"lift": {"sitting": "no"}}, "sitting: found 'no', expected True or False"),
        ({"lift": {"start": "gras"}}, "no mark 'gras'; the movement has: grasp, release"),
        ({"look": {"start": "grasp"}}, "the movement has: none"),
        ({"lift": {"end": 1.5}}, "end: found 1.5, expected the name of a mark, or a share from 0 to 1"),
    ],
)
def test_a_mistake_is_named_with_its_place(said, found):
    with pytest.raises(ValueError) as caught:
        handlings(said, MODELS)
    assert found in str(caught.value)


def test_all_mistakes_are_said_at_once():
    with pytest.raises(ValueError) as caught:
        handlings({"lift": {"load_kg": -1, "grip": "x"}, "lok": {}}, MODELS)
    assert len(str(caught.value).splitlines()) == 3
    with pytest.raises(TypeError, match="expected a mapping"):
        handlings([1], MODELS)
