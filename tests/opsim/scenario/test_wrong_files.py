"""Wrong scenarios and the complete answer to each, in ``wrong_files.txt``: a claim, edits of ``good.yaml``, the answer.

After a change of words: ``python tests/opsim/scenario/test_wrong_files.py`` writes the answers anew; read them before
they are committed.
"""

from pathlib import Path

import pytest

from opsim.problems import ScenarioError
from opsim.scenario.read import scenarios_in

HERE = Path(__file__).parent
GOOD = (HERE / "good.yaml").read_text(encoding="utf-8")
WRONG_FILES = HERE / "wrong_files.txt"


def cases():
    """(claim, edits, answer) of every case; an edit replaces one text by another, backslash-n is a new line."""
    for block in WRONG_FILES.read_text(encoding="utf-8").removeprefix("# ").split("\n# "):
        claim, *lines = block.rstrip("\n").split("\n")
        n_edits = sum(1 for line in lines if line[:2] == "- ")
        edits = [
            (lines[2 * i][2:].replace("\\n", "\n"), lines[2 * i + 1][2:].replace("\\n", "\n")) for i in range(n_edits)
        ]
        yield claim, edits, "\n".join(lines[2 * n_edits :])


def answer(edits):
    """What the reader says of the good scenario with these edits."""
    text = GOOD
    for old, new in edits:
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in good.yaml"
        text = text.replace(old, new)
    with pytest.raises(ScenarioError) as caught:
        scenarios_in(text.encode(), Path("line.yaml"))
    return str(caught.value)


def renew():
    """Write every answer anew."""
    blocks = []
    for claim, edits, _ in cases():
        pairs = [f"{sign} {text}".replace("\n", "\\n") for pair in edits for sign, text in zip("-+", pair)]
        blocks.append("\n".join([f"# {claim}", *pairs, answer(edits)]) + "\n")
    WRONG_FILES.write_text("".join(f"{block}\n" for block in blocks).rstrip("\n") + "\n", encoding="utf-8")


@pytest.mark.parametrize(("claim", "edits", "expected"), [pytest.param(*case, id=case[0]) for case in cases()])
def test_a_wrong_file_gets_its_whole_answer(claim, edits, expected):
    assert answer(edits) == expected


def test_the_good_file_is_good():
    assert list(scenarios_in(GOOD.encode(), Path("line.yaml"))) == ["base", "near"]


def test_no_answer_speaks_the_schema_s_own_language():
    said = WRONG_FILES.read_text(encoding="utf-8")
    assert not [word for word in ("Input should", "type=", "valid dictionary", "pydantic", "None") if word in said]


if __name__ == "__main__":
    renew()
