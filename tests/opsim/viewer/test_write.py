import base64
import gzip
import json
import re

import numpy as np
import pytest

from opsim.report.page import policy
from opsim.viewer.write import page_script, write_replay

META = {"name": "base", "title": "A cell", "notes": [["Walking", "made up"]], "columns": {}}
HOSTILE = "</script><script>window.harmed = 1</script>"


def written(tmp_path, parts, title="A cell", notes=()):
    path = tmp_path / "replay.html"
    size = write_replay(parts, path, title, notes)
    text = path.read_text(encoding="utf-8")
    assert size == path.stat().st_size
    return text


def column_bytes(text, number):
    block = re.search(rf'<script type="text/plain" id="columns-{number}">([^<]*)</script>', text).group(1)
    return gzip.decompress(base64.b64decode(block))


def test_the_columns_come_back_as_they_were(tmp_path):
    rng = np.random.default_rng(0)
    parts = [(META, rng.bytes(size)) for size in (0, 8, 3_000_008)]  # noise: gzip does not make it smaller
    text = written(tmp_path, parts)
    assert [column_bytes(text, number) for number in range(3)] == [columns for _, columns in parts]


def test_the_same_parts_give_the_same_bytes(tmp_path):
    assert written(tmp_path, [(META, bytes(80))]) == written(tmp_path, [(META, bytes(80))])


def test_names_are_escaped_wherever_they_stand(tmp_path):
    meta = {**META, "name": HOSTILE, "notes": [[HOSTILE, HOSTILE]]}
    text = written(tmp_path, [(meta, b"")], HOSTILE, [(HOSTILE, HOSTILE)])
    assert HOSTILE not in text
    told = json.loads(re.search(r'id="replay">(.*?)</script>', text).group(1))
    assert told["title"] == told["variants"][0]["name"] == HOSTILE


def test_a_note_that_variants_share_stands_once(tmp_path):
    text = written(tmp_path, [(META, b""), (META, b"")], notes=[("From", "a test")])
    assert text.count("<dt>Walking</dt><dd>made up</dd>") == 1 and "<dt>From</dt><dd>a test</dd>" in text


def test_only_the_page_s_own_script_may_run(tmp_path):
    text = written(tmp_path, [(META, b"")])
    allowed = policy(page_script()).replace("'", "&#39;")
    assert f'content="{allowed}"' in text and page_script() in text
    assert "eval(" not in page_script() and "new Function" not in page_script() and "</script" not in page_script()


def test_a_replay_of_nothing_is_refused(tmp_path):
    with pytest.raises(ValueError, match="a variant at least"):
        write_replay([], tmp_path / "replay.html", "nothing")
