"""fields.vtu in the library of ParaView, summary.md through a renderer."""

import csv
import re

import pytest
from markdown_it import MarkdownIt
from vtkmodules.vtkFiltersTensor import vtkTensorPrincipalInvariants

from conftest import ROOT
from vtu import read

COMPONENTS = ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]


def test_stresses_are_tensors(made):
    grid = read(made / "agree" / "fields.vtu")
    data = grid.GetPointData()
    assert data.GetTensors().GetName() == "dual_stress"
    for name in ("dual_stress", "mid_stress", "stress_FEniCSx_P1", "stress_FEniCSx_P2", "stress_difference_FEniCSx_P2"):
        array = data.GetArray(name)
        assert [array.GetComponentName(k) for k in range(array.GetNumberOfComponents())] == COMPONENTS, name
    # Principal stresses, found by VTK from the six components: their sum is three times the mean stress.
    invariants = vtkTensorPrincipalInvariants()
    invariants.SetInputData(grid)
    invariants.SetInputArrayToProcess(0, 0, 0, 0, "dual_stress")
    invariants.Update()
    found = invariants.GetOutput().GetPointData()
    principal = [found.GetArray(f"dual_stress - Sigma {k}") for k in (1, 2, 3)]
    mean = data.GetArray("mean_stress")
    for point in range(0, grid.GetNumberOfPoints(), 37):
        total = sum(array.GetValue(point) for array in principal)
        assert total == pytest.approx(3 * mean.GetValue(point), abs=1e-6)


def test_stresses_jump_between_triangles(made):
    grid = read(made / "agree" / "fields.vtu")
    dual, points = grid.GetPointData().GetArray("dual_stress"), {}
    for k in range(grid.GetNumberOfPoints()):
        points.setdefault(grid.GetPoint(k), []).append(dual.GetTuple(k))
    jumps = [max(s[0] for s in all) - min(s[0] for s in all) for all in points.values() if len(all) > 3]
    assert max(jumps) > 0.1, "the stress in the plane of a side jumps"


def test_a_difference_is_that_of_the_two(made):
    data = read(made / "agree" / "fields.vtu").GetPointData()
    dual, other, apart = (data.GetArray(n) for n in ("dual_stress", "stress_FEniCSx_P1", "stress_difference_FEniCSx_P1"))
    for k in range(0, dual.GetNumberOfTuples(), 11):
        expected = [a - b for a, b in zip(dual.GetTuple(k), other.GetTuple(k))]
        assert list(apart.GetTuple(k)) == pytest.approx(expected, abs=1e-12)


def test_the_file_says_of_which_scene_it_is(made):
    data = read(made / "agree" / "fields.vtu").GetFieldData()
    text = lambda name: bytes(int(data.GetArray(name).GetValue(k)) for k in range(data.GetArray(name).GetNumberOfValues())).decode()  # noqa: E731
    assert text("scene") == "two_blocks" and len(text("scene_sha256")) == 64


def test_every_array_and_column_is_in_the_documentation(made):
    page = (ROOT / "docs" / "fields.md").read_text()
    models = {"MODEL": r"(FEniCSx_P[12]|free_upper_bound)", "NAME": "tip"}
    rows = [re.findall(r"`([^`]+)`", line.split("|")[1]) for line in page.splitlines() if line.startswith("| `")]
    known = [re.sub("MODEL|NAME", lambda found: models[found[0]], name) for row in rows for name in row]
    grid = read(made / "agree" / "fields.vtu")
    for data in (grid.GetPointData(), grid.GetCellData(), grid.GetFieldData()):
        for name in (data.GetArrayName(k) for k in range(data.GetNumberOfArrays())):
            assert any(re.fullmatch(pattern, name) for pattern in known), name
    for path in (made / "agree").glob("*.csv"):
        assert path.name in known


def test_the_summary_is_markdown(made):
    html = MarkdownIt("commonmark", {"html": False}).enable("table").render((made / "drop" / "summary.md").read_text())
    assert html.startswith("<h2>") and "<table>" in html and "<strong>In FEniCSx P1 and FEniCSx P2 contact" in html
    assert "|---" not in html and "**" not in html


def test_tables_are_read_as_tables(made):
    with open(made / "drop" / "checks.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["check"] for row in rows if row["outcome"] == "failed" and row["decides"] == "true"] == [
        "admissible/FEniCSx P1", "admissible/FEniCSx P2",
    ]  # fmt: skip
    with open(made / "drop" / "contacts.csv", newline="", encoding="utf-8") as file:
        points = list(csv.DictReader(file))
    assert {row["contact"] for row in points} == {"left_face|right_face"} and {"dual", "FEniCSx P2 trace"} <= {row["model"] for row in points}
