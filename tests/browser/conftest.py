"""Pages and files as the program leaves them, and a browser without a network that looks at them."""

import os
import pathlib
import shutil
import subprocess

import pytest
from playwright.sync_api import sync_playwright

ROOT = pathlib.Path(__file__).parents[2]
PROGRAM = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug" / "hypercircle"
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
]  # fmt: skip
REDUCED = ROOT / "out" / "figures" / "reduced"

TWO_BLOCKS = (ROOT / "cases" / "two_blocks.toml").read_text()
QUANTITY = '\n[[quantities]]\nname = "tip"\ndisplacement = "left_load"\ndirection = [1, 0]\n'
ODD = TWO_BLOCKS.replace("Two blocks, eccentric traction: lift-off", "<b>\u05e9\u05dc\u05d5\u05dd</b> \u202eabc & so on")


def hypercircle(*words, code):
    """Runs the program and returns what it said."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """The folder of all results: agree, drop, fine, odd, proved, job."""
    folder = tmp_path_factory.mktemp("made")
    scene, odd = folder / "two_blocks.toml", folder / "odd.toml"
    scene.write_text(TWO_BLOCKS + QUANTITY)
    odd.write_text(ODD)
    hypercircle("verify", scene, "--out", folder / "agree", code=0)
    hypercircle("verify", scene, "--sabotage", "drop-row", "--out", folder / "drop", code=1)
    hypercircle("verify", scene, "--refine", 3, "--out", folder / "fine", code=0)
    hypercircle("solve", odd, "--out", folder / "odd", code=0)
    hypercircle("solve", scene, "--proof", "--out", folder / "proved", code=0)
    scenes = folder / "scenes"
    scenes.mkdir()
    for name in ("patch", "gap"):
        shutil.copy(ROOT / "cases" / f"{name}.toml", scenes)
    (scenes / "broken.toml").write_text("[model]\nkinematics = 'round'\n")
    hypercircle("solve", scenes, "--out", folder / "job", code=2)
    return folder


@pytest.fixture(scope="session")
def pages(made):
    """Every kind of page by its name; chart and stability are those of `ci/figures reduced`."""
    kinds = {name: made / name / "report.html" for name in ("agree", "drop", "fine", "odd")}
    charts = {name: REDUCED / name / f"{name}.html" for name in ("chart", "stability")}
    for path in charts.values():
        assert path.exists(), f"{path} is missing: run ci/figures reduced"
    return {**kinds, "why": made / "proved" / "why.html", "job": made / "job" / "index.html", **charts}


@pytest.fixture(scope="session")
def chromium(tmp_path_factory):
    with sync_playwright() as playwright:
        profile = tmp_path_factory.mktemp("profile")
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS, env={**os.environ, "HOME": str(profile)})
        yield browser
        browser.close()


@pytest.fixture
def opened(chromium):
    """Opens a file with the network cut; at the end nothing may have been asked of it, and nothing said on the console."""
    contexts, said = [], []

    def look_at(path, width=1280, **more):
        context = chromium.new_context(viewport={"width": width, "height": 900}, offline=True, **more)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("request", lambda request: request.url.startswith("file:") or said.append(request.url))
        page.goto(f"file://{path}")
        if more.get("java_script_enabled", True) and page.locator("#map").count():
            page.wait_for_selector("#map[data-ready]")
        return page

    yield look_at
    for context in contexts:
        context.close()
    assert said == []
