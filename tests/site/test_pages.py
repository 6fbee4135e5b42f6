"""The pages of the documentation as files: every link leads somewhere, every page is in the table of contents, every key of a scene has its section.

`ci/site` builds them; HYPERCIRCLE names the program whose schema they are compared with.
"""

import json
import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("HYPERCIRCLE") or ROOT / "target/debug/hypercircle")
OUTSIDE = ("http://", "https://", "mailto:")
DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", ROOT / "cases/README.md", *DOCS]
GALLERY = [page for page in DOCS if page.parent.name == "gallery" and page.stem != "index"]
named = lambda page: str(page.relative_to(ROOT))


def without_code(text):
    """A page without fenced blocks and code in lines, which may look like links."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def anchors(page):
    """Valid targets of `#…` on a page: its headings as GitHub and MyST write them, and anchors of HTML."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    found, counts = set(re.findall(r'<a (?:id|name)="([^"]+)"', text)), {}
    for heading in re.findall(r"^#+ +(.*?) *$", text, flags=re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.add(f"{slug}-{counts[slug]}" if slug in counts else slug)
        counts[slug] = counts.get(slug, 0) + 1
    return found


def wrong(page, target):
    """Why a link of a page leads nowhere, None where it leads somewhere."""
    path, _, anchor = target.partition("#")
    if path.startswith("/made/"):  # made by docs/site/gallery.py from the report of the page's own command
        return None if re.fullmatch(rf"/made/{page.stem}/([\w-]+\.svg|printed\.txt)", path) else "that is no picture of this page"
    there = ROOT / path[1:] if path.startswith("/") else (page.parent / path if path else page)
    if not there.exists():
        return f"there is no {path}"
    if anchor and there.suffix == ".md" and anchor not in anchors(there):
        return f"{named(there.resolve())} has no heading #{anchor}"
    return None


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_somewhere(page):
    text = page.read_text(encoding="utf-8")
    targets = re.findall(r"\]\(([^)\s]+)\)", without_code(text))
    targets += re.findall(r"^```\{(?:literal)?include\} (\S+)$", text, flags=re.MULTILINE)
    dead = {target: why for target in targets if not target.startswith(OUTSIDE) and (why := wrong(page, target))}
    assert not dead, f"{named(page)}: {dead}"


def test_a_dead_link_is_seen():
    page = ROOT / "docs/verdict.md"
    for target in ("nowhere.md", "theory.md#nothing", "#nothing", "/made/verdict/../x.svg", "/cases/nothing.toml"):
        assert wrong(page, target), target
    for target in ("theory.md", "theory.md#bodies-of-revolution", "../README.md", "/cases/two_blocks.toml"):
        assert wrong(page, target) is None, target


def test_every_page_is_in_the_table_of_contents_once():
    entries = []
    for page in DOCS:
        for block in re.findall(r"^```\{toctree\}\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE):
            for line in (line for line in block.splitlines() if line and not line.startswith(":")):
                name = re.sub(r".*<(.*)>", r"\1", line)
                entries.append((page.parent / f"{name}.md").resolve())
    assert sorted(entries) == sorted(page for page in PAGES if page != ROOT / "docs/index.md")


def keys(schema):
    """The places of all keys in a JSON Schema, such as `bodies.temperature.value`: names of bodies and indices are left out."""
    found = set()

    def walk(node, place):
        if "$ref" in node:
            walk(schema["$defs"][node["$ref"].rsplit("/", 1)[-1]], place)
        inner = [option for group in ("anyOf", "oneOf", "allOf") for option in node.get(group, [])]
        inner += [node[name] for name in ("items", "additionalProperties") if isinstance(node.get(name), dict)]
        for part in inner:
            walk(part, place)
        for key, value in node.get("properties", {}).items():
            found.add(f"{place}{key}")
            walk(value, f"{place}{key}.")

    walk(schema, "")
    return found


def test_every_key_of_a_scene_has_its_section():
    schema = json.loads(subprocess.run([PROGRAM, "schema", "scene"], capture_output=True, check=True, timeout=60).stdout)
    sections = re.findall(r"^#+ `([\w.]+)`$", (ROOT / "docs/scene.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert len(sections) == len(set(sections)), "a key has two sections"
    assert set(sections) == keys(schema), f"only in one of the two: {sorted(set(sections) ^ keys(schema))}"


def test_lines_of_the_scene_reference_can_be_copied():
    text = (ROOT / "docs/scene.md").read_text(encoding="utf-8")
    parts = re.split(r"^#+ `([\w.]+)`$", text, flags=re.MULTILINE)
    for key, section in zip(parts[1::2], parts[2::2]):
        lines = "".join(re.findall(r"^```toml\n(.*?)^```", section, flags=re.DOTALL | re.MULTILINE))
        tomllib.loads(lines)
        assert re.search(rf"\b{key.rsplit('.', 1)[-1]}\b", lines), f"the lines below `{key}` do not have it"


def test_commands_of_the_gallery_name_scenes_and_pictures():
    assert len(GALLERY) >= 8
    for page in GALLERY:
        text = page.read_text(encoding="utf-8")
        command = re.match(r"---\ncommand: hypercircle solve (\S+)( .*)?\n---\n", text)
        assert command, f"{named(page)} has no command"
        assert f"```{{literalinclude}} /{command[1]}\n" in text, f"{named(page)} does not show {command[1]}"
        assert f"/made/{page.stem}/printed.txt" in text and f"/made/{page.stem}/scene-picture.svg" in text, named(page)
        assert f"reports/{page.stem}.html" in text, named(page)
