"""Pages of docs/ with programs in Python: each block is run, in one session a page, and prints the text that follows it."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
BLOCK = re.compile(r"```(python|text)\n(.*?)```", re.DOTALL)
PAGES = [page.name for page in sorted(DOCS.glob("*.md")) if "```python\n" in page.read_text(encoding="utf-8")]


@pytest.mark.parametrize("name", PAGES)
def test_the_page_prints_what_it_says(name, hypercircle, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = BLOCK.findall((DOCS / name).read_text(encoding="utf-8"))
    assert "text" in [kind for kind, _ in blocks]
    names, printed = {}, ""
    for kind, block in blocks:
        if kind == "text":
            assert printed == block
            printed = ""
        else:
            assert not printed, "what a block prints is on the page"
            exec(compile(block, str(DOCS / name), "exec"), names)
            printed = capsys.readouterr().out
    assert not printed
    if name == "python.md":
        assert names["scene"].diagnose(names["points"], names["triangles"], names["right"]) is None


def test_both_tutorials_are_run():
    assert {"python.md", "workbench.md"} <= set(PAGES)
