"""Version and description of a release, in every file that has them."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
read = lambda name: (ROOT / name).read_text(encoding="utf-8")


def test_one_version_everywhere(hypercircle):
    version = tomllib.loads(read("Cargo.toml"))["workspace"]["package"]["version"]
    assert hypercircle.__version__ == version
    assert re.search(r"^version: (.*)$", read("CITATION.cff"), re.M)[1] == version
    assert re.search(r'^  version: "(.*)"$', read("packaging/conda/recipe.yaml"), re.M)[1] == version
    assert re.search(r"^## (\S+)", read("CHANGELOG.md"), re.M)[1] == version


def test_the_paper_has_what_joss_asks():
    _, head, body = read("paper.md").split("---\n", 2)
    for key in ("title", "tags", "authors", "affiliations", "date", "bibliography"):
        assert re.search(rf"^{key}:", head, re.M), key
    headings = re.findall(r"^# (.*)$", body, re.M)
    assert headings[:2] == ["Summary", "Statement of need"] and headings[-1] == "References"
    assert 250 < len(body.split()) < 1000
    cited = set(re.findall(r"@(\w+)", body))
    known = set(re.findall(r"^@\w+\{(\w+),", read("paper.bib"), re.M))
    assert cited == known and (ROOT / "LICENSE-MIT").is_file() and (ROOT / "CONTRIBUTING.md").is_file()


def test_what_the_image_and_the_workflows_call_is_there():
    for name in ("Dockerfile", ".github/workflows/release.yml", ".github/workflows/test.yml", "ci/image", "ci/wheel"):
        for script in re.findall(r"(?<![\w/])(ci/[a-z-]+)", read(name)):
            assert (ROOT / script).is_file(), f"{name}: {script}"
    archive = re.search(r"hypercircle-[\w-]+\.tar\.gz", read("action.yml"))[0]
    assert archive in read(".github/workflows/release.yml")
