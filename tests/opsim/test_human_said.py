import pytest

from opsim.external_draws import human_of
from opsim.human.fatigue import Lffrm, RestByNeed
from opsim.plan.workers import NO_EFFECTS, HumanPlan

MODELS = {"w10": None, "w2": None}


def read(said, experience=None, start_s=0.0):
    return human_of("ana", said, experience, MODELS, start_s)


def test_words_are_read_as_in_a_scenario():
    plan = read({"fatigue": {"model": "lffrm", "tires_half_in": "2 h"}, "acts_on": "time"})
    assert plan.fatigue == Lffrm(tires_half_in_s=7200.0) and plan.acts_on == "time" and plan.learning is None
    assert read(HumanPlan(fatigue=Lffrm())).fatigue == Lffrm()
    assert read(HumanPlan(fatigue=Lffrm(), start_s=60.0)).start_s == 60.0
    assert read(None) is NO_EFFECTS and not read({}).any


def test_experience_is_by_task_in_natural_order():
    learning = {"learning": {"model": "wright"}}
    assert read(learning, {"w10": 7}).experience == ((0.0, 7.0),)
    assert read(learning, {"w2": 0}).experience == () and read(learning, start_s=60).start_s == 60.0


@pytest.mark.parametrize(
    ("said", "found"),
    [
        (
            {"fatigue": {"model": "lfrm"}},
            "worker ana: human.fatigue.model: no model of fatigue is called 'lfrm'; did you",
        ),
        ({"fatigue": {"model": "lffrm", "slow": 1}}, "human.fatigue.slow: unknown key 'slow'; did you mean 'slows'?"),
        ({"fatigue": {"model": "lffrm", "tires_half_in": 7200}}, "human.fatigue.tires_half_in:"),
        ({"fatigue": {"model": "lffrm", "slows": -1}}, "human.fatigue.slows: must be at least 0, found -1"),
        ({"fatigue": "lffrm"}, "human.fatigue: expected a block of keys, found 'lffrm'; write {model: lffrm}"),
        (
            {"error": {}},
            "human.error: unknown key 'error'; here are: acts_on, circadian, fatigue, forgetting, learning",
        ),
        ({"fatige": {}}, "human.fatige: unknown key 'fatige'; did you mean 'fatigue'?"),
        ({"state_pace": {"model": "schultz"}}, "human.state_pace: not in a model of your own; it looks at the buffers"),
        ({"rest": {"above": 0.5}}, "human.rest: not in a model of your own; who sends your workers is your model"),
        ({"errors": {"at_full_fatigue": 0.1}}, "human.errors: not in a model of your own"),
        ({"absence": 0.1}, "human.absence: not in a model of your own"),
        ({"forgetting": {"model": "lfcm"}}, "human.forgetting: nothing is forgotten where nobody learns"),
        (HumanPlan(experience=((1.0, 2.0),)), "give the Worker experience={task: n}"),
        (HumanPlan(rest=RestByNeed(above=0.5, until=0.2)), "human.rest: not in a model of your own"),
    ],
)
def test_a_mistake_is_named_with_its_place_and_the_nearest_word(said, found):
    with pytest.raises(ValueError) as caught:
        read(said)
    assert found in str(caught.value)


def test_all_mistakes_are_said_at_once():
    with pytest.raises(ValueError) as caught:
        read({"rest": {}, "fatigue": {"model": "lffrm", "slows": -1, "slwo": 3}})
    assert len(str(caught.value).splitlines()) == 3


def test_what_is_no_mapping_or_no_number_is_refused():
    with pytest.raises(TypeError, match="expected a mapping of effects or a HumanPlan, found 3"):
        read(3)
    with pytest.raises(TypeError, match="expected a mapping of tasks"):
        read(None, [3])
    learning = {"learning": {"model": "wright"}}
    with pytest.raises(ValueError, match="no task 'w3'") as caught:
        read(learning, {"w3": 1, "w2": -1})
    assert "experience of w2: found -1, expected repetitions from 0" in str(caught.value)
    with pytest.raises(ValueError, match="where nobody learns"):
        read(None, {"w2": 5})
    with pytest.raises(ValueError, match="start_s must be seconds"):
        read(None, start_s="06:00")
