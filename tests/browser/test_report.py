"""The report of one scene: reading values, choosing maps, paper, no scripts."""

import io
import math
import re

import pytest
from pypdf import PdfReader

from vtu import of_triangle, read

KNOWN = 100
MAPS = {
    "dual": "von_mises_dual",
    "FEniCSx P1": "von_mises_FEniCSx_P1",
    "FEniCSx P2": "von_mises_FEniCSx_P2",
    "difference dual − FEniCSx P2": "difference_density_FEniCSx_P2",
}


def told(page):
    """Triangle, and what is said of it by kind and name of the map."""
    text = page.locator("#map output").inner_text()
    triangle = int(re.match(r"Triangle (\d+) ", text)[1])
    values = {}
    for line in text.splitlines()[1:]:
        for part in line.split(": ", 1)[1].split(", "):
            name, value = part.rsplit(" ", 1)
            values.setdefault(name, float(value.replace("\u2212", "-")))
    return triangle, values


def middle(grid, triangle):
    """Of a triangle of the mesh, from the three cells that it has."""
    of = grid.GetCellData().GetArray("triangle")
    own = [k for k in range(grid.GetNumberOfCells()) if of.GetValue(k) == triangle]
    points = [grid.GetCell(k).GetPoints().GetPoint(i) for k in own for i in range(2)]
    return [sum(p[c] for p in points) / len(points) for c in range(2)]


def on_page(page, x, y):
    """Where a point of the two blocks, [0, 2] x [0, 1], is on the screen: the picture leaves 8 of 560 units at each side."""
    box = page.locator("#map .stage").bounding_box()
    unit = box["width"] / 560
    scale = (560 - 16) / 2 * unit
    return box["x"] + 8 * unit + scale * x, box["y"] + box["height"] - 8 * unit - scale * y


def test_pointing_at_a_triangle_tells_its_values(opened, made):
    page, grid = opened(made / "drop" / "report.html"), read(made / "drop" / "fields.vtu")
    page.locator("#map").scroll_into_view_if_needed()
    page.mouse.move(*on_page(page, *middle(grid, KNOWN)))
    triangle, values = told(page)
    assert triangle == KNOWN
    for name, key in MAPS.items():
        assert values[name] == pytest.approx(of_triangle(grid, key, KNOWN), rel=2e-4), name


def test_arrow_keys_go_to_the_neighbour_and_tell_its_values(opened, made):
    page, grid = opened(made / "agree" / "report.html"), read(made / "agree" / "fields.vtu")
    page.locator("#map").scroll_into_view_if_needed()
    page.mouse.move(*on_page(page, *middle(grid, KNOWN)))
    page.locator("#map .stage").focus()
    page.keyboard.press("ArrowRight")
    triangle, values = told(page)
    assert triangle != KNOWN and middle(grid, triangle)[0] > middle(grid, KNOWN)[0]
    assert values["dual"] == pytest.approx(of_triangle(grid, "von_mises_dual", triangle), rel=2e-4)
    page.keyboard.press("+")
    assert float(page.locator("#map .stage svg").get_attribute("viewBox").split()[2]) < 560
    page.keyboard.press("0")
    assert float(page.locator("#map .stage svg").get_attribute("viewBox").split()[2]) == 560


def test_cells_of_a_fine_mesh_tell_the_values_of_their_triangle(opened, made):
    page, grid = opened(made / "fine" / "report.html"), read(made / "fine" / "fields.vtu")
    page.locator("#map").scroll_into_view_if_needed()
    page.mouse.move(*on_page(page, 1.5, 0.5))
    triangle, values = told(page)
    x, y = middle(grid, triangle)
    assert abs(x - 1.5) < 0.03 and abs(y - 0.5) < 0.03
    assert values["dual"] == pytest.approx(of_triangle(grid, "von_mises_dual", triangle), rel=2e-4)
    assert (made / "fine" / "report.html").stat().st_size < 1_000_000
    assert (made / "fine" / "fields.vtu").stat().st_size < 10_000_000


def test_the_choice_changes_the_map(opened, made):
    page = opened(made / "agree" / "report.html")
    draw = "document.querySelector('#map canvas').toDataURL()"
    before = page.evaluate(draw)
    assert page.locator("#map .what b").inner_text().startswith("Stress difference")
    page.locator("#map select").select_option(label="half-way between the bounds")
    assert page.evaluate(draw) != before
    assert page.locator("#map .what b").inner_text().startswith("Von Mises stress, half-way")
    assert page.locator("#map .bar:visible").count() == 1
    page.locator("#map select").select_option(label="tip")
    assert page.locator("#map .what b").inner_text().startswith("Share in the interval, tip")


def test_without_scripts_everything_but_the_comfort_is_there(opened, made):
    page = opened(made / "drop" / "report.html", java_script_enabled=False)
    assert page.locator("#map .cells path").count() > 10
    assert not page.locator("#map .tools").is_visible() and page.locator("#map .bar:visible").count() == 1
    first = page.locator(".cause").first.inner_text()
    assert "left_face|right_face" in first and "does not act" in first and "at (1, " in first
    page.locator("#checks details.passing summary").click()
    assert page.locator("#checks details.passing tbody tr").first.is_visible()


def test_a_check_leads_to_its_picture_and_back(opened, made):
    page = opened(made / "drop" / "report.html")
    row = page.locator("#checks tr.no").first
    row.get_by_role("link").click()
    assert page.url.endswith("#shapes")
    page.locator("#shapes .back a").first.click()
    assert page.url.endswith("#" + row.get_attribute("id"))
    # One that passed is unfolded by the link to it.
    page.locator("#bracket .back summary").click()
    page.locator("#bracket .back a").last.click()
    page.wait_for_function("document.querySelector(location.hash).checkVisibility()")


def test_marks_are_in_every_picture(opened, made):
    page = opened(made / "drop" / "report.html")
    for figure in ("#scene-picture", "#map", "#pressure-0", "#shapes"):
        assert page.locator(f"{figure} .place[data-cause='1']").count() == 1, figure


def test_tables_are_sorted_on_request(opened, made):
    page = opened(made / "agree" / "report.html")
    page.locator("#checks details.passing summary").click()
    table = page.locator("#checks details.passing table")
    table.get_by_role("button", name="margin").click()
    cells = table.locator("tbody td:nth-child(7)").evaluate_all("all => all.map(cell => Number(cell.dataset.value))")
    assert cells == sorted(cells) and len(set(cells)) > 5


@pytest.mark.parametrize(("name", "expected"), [("agree", 12), ("drop", 12)])
def test_paper_has_the_pages_that_it_takes(opened, made, name, expected):
    page = opened(made / name / "report.html")
    sheets = [sheet.extract_text() for sheet in PdfReader(io.BytesIO(page.pdf(format="A4", prefer_css_page_size=True))).pages]
    figures = page.locator("#pictures figure").count()
    begin = {word: next(n for n, text in enumerate(sheets) if text.lstrip().startswith(word)) for word in ("Pictures", "Checks", "Energy")}
    # Two pictures on each sheet, the parts on sheets of their own, in their order, and none that is nearly empty.
    assert begin["Checks"] - begin["Pictures"] == math.ceil(figures / 2)
    assert 0 < begin["Pictures"] < begin["Checks"] < begin["Energy"] < len(sheets)
    assert all(len(text) > 100 for text in sheets), [len(text) for text in sheets]
    assert "Made by hypercircle" in sheets[-1]
    assert len(sheets) == expected
