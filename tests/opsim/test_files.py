import pytest

from opsim.files import NotInside, inside


@pytest.mark.parametrize(
    "name", ["../x.csv", "/etc/passwd", "a/../../x", "C:/x", "\\\\host\\x", "..\\x", "", " ", "a\0b", "x" * 600]
)
def test_a_name_that_leads_out_is_refused(tmp_path, name):
    with pytest.raises(NotInside):
        inside(name, tmp_path)


def test_the_first_folder_that_has_the_file_wins(tmp_path):
    for folder in ("one", "two"):
        (tmp_path / folder / "sub").mkdir(parents=True)
    (tmp_path / "two/sub/x.csv").write_text("1\n")
    assert inside("sub/x.csv", tmp_path / "one", tmp_path / "two") == tmp_path / "two/sub/x.csv"
    (tmp_path / "one/sub/x.csv").write_text("1\n")
    assert inside("sub/x.csv", tmp_path / "one", tmp_path / "two") == tmp_path / "one/sub/x.csv"
    assert inside("sub", tmp_path / "one") is None
