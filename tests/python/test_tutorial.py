"""docs/python.md: each block of code is run, in one session, and prints the text that follows it."""

import re
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs/python.md"


def test_the_page_prints_what_it_says(hypercircle, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```(python|text)\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert [kind for kind, _ in blocks].count("text") > 5
    names, printed = {}, ""
    for kind, block in blocks:
        if kind == "text":
            assert printed == block
            printed = ""
        else:
            assert not printed, "what a block prints is on the page"
            exec(compile(block, str(PAGE), "exec"), names)
            printed = capsys.readouterr().out
    assert not printed
    assert names["scene"].diagnose(names["points"], names["triangles"], names["right"]) is None
