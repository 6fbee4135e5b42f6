"""Every kind of page: who cannot see, who has a small screen, who reads at night."""

import pytest
from axe_playwright_python.sync_playwright import Axe

PAGES = ["agree", "drop", "fine", "odd", "why", "job", "chart", "stability"]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("name", PAGES)
def test_nothing_stands_in_the_way_of_a_reader(opened, pages, name, scheme):
    page = opened(pages[name], color_scheme=scheme)
    if name == "stability":
        # One regime is shown as another is, and all of them take long.
        assert page.evaluate("[...document.querySelectorAll('section[id]')].slice(6).map(e => e.remove()).length") > 10
    violations = Axe().run(page).response["violations"]
    told = [(v["id"], v["nodes"][0]["html"][:200], v["nodes"][0].get("failureSummary")) for v in violations]
    assert told == []


@pytest.mark.parametrize("name", PAGES)
def test_a_telephone_shows_all_of_it(opened, pages, name):
    page = opened(pages[name], width=390)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    # Figures fit, and their letters can be read.
    for svg in page.locator("main figure:visible > svg, main .stage svg").all():
        box = svg.bounding_box()
        assert box["x"] + box["width"] <= 390


@pytest.mark.parametrize("name", PAGES)
def test_nothing_is_cut_on_paper(opened, pages, name):
    page = opened(pages[name])
    # A4 without margins, at 96 pixels an inch.
    width, height = (1009, 688) if name == "stability" else (688, 1009)
    page.set_viewport_size({"width": width, "height": height})
    page.emulate_media(media="print")
    wide = page.evaluate(
        "[...document.querySelectorAll('main *, header *')].filter(e => e.checkVisibility() && "
        "!e.closest('svg') && e.getBoundingClientRect().right > innerWidth + 1).map(e => e.outerHTML.slice(0, 80))"
    )
    assert not wide
    tall = page.evaluate("[...document.querySelectorAll('figure')].filter(e => e.offsetHeight > innerHeight / 2).map(e => e.id)")
    assert not tall


@pytest.mark.parametrize("name", PAGES)
def test_there_is_one_heading_and_one_main_part(opened, pages, name):
    page = opened(pages[name], java_script_enabled=False)
    assert page.locator("h1").count() == 1 and page.locator("main").count() == 1
    assert page.locator("html[lang]").count() == 1


def test_names_that_run_from_right_to_left_turn_nothing(opened, pages):
    page = opened(pages["odd"])
    title = page.locator("h1")
    assert "<b>" in title.inner_text() and "\u202e" not in title.inner_text() and "\ufffd" in title.inner_text()
    assert title.locator("bdi").count() == 1
