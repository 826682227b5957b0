import base64
import hashlib

import jinja2
import pytest

from opsim.report.page import asset, policy, template


def test_only_the_scripts_as_they_stand_may_run():
    digest = base64.b64encode(hashlib.sha256(b"1 + 1").digest()).decode()
    assert f"script-src 'sha256-{digest}';" in policy("1 + 1") and "default-src 'none'" in policy("1 + 1")
    assert policy("1 + 1").endswith("base-uri 'none'; form-action 'none'")
    assert "unsafe-inline" not in policy("1 + 1").partition("script-src")[2].partition(";")[0]


def test_a_name_that_the_page_needs_and_nobody_gives_is_an_error():
    with pytest.raises(jinja2.UndefinedError):
        template("animated.html.jinja").render()


@pytest.mark.parametrize("name", ["report.css", "report.js", "animated.css", "guess.js"])
def test_our_scripts_and_styles_fetch_nothing(name):
    text = asset(name)
    assert "</script" not in text and "</style" not in text
    assert not any(word in text for word in ("http:", "https:", "//cdn", "fetch(", "XMLHttpRequest", "@import", "url("))
