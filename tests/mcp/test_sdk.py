"""The five tools, called by the client of the SDK, which holds every answer against the schemas of protocol and tools."""

import json

import pytest
from conftest import POINTS, SCENE, TRIANGLES, exact
from mcp import MCPError

ARRAYS = {"points": POINTS, "triangles": TRIANGLES}


@pytest.fixture
def call(session):
    """Calls one tool; gives its data, its words and whether it is an error."""

    def called(tool, *words, **arguments):
        async def work(client):
            return await client.call_tool(tool, arguments)

        result = session(work, *words)
        text, data = result.content
        assert json.loads(data.text) == result.structured_content
        return result.structured_content, text.text, result.is_error

    return called


def test_a_client_is_told_what_there_is(session):
    async def work(client):
        tools = (await client.list_tools()).tools
        resources = (await client.list_resources()).resources
        texts = [(await client.read_resource(resource.uri)).contents[0].text for resource in resources]
        return client.server_info, client.instructions, tools, texts

    info, instructions, tools, (schema, example) = session(work)
    assert info.name == "hypercircle" and "[[quantities]]" in instructions
    assert [tool.name for tool in tools] == ["solve", "verify", "certify", "diagnose", "element"]
    for tool in tools:
        assert tool.input_schema["additionalProperties"] is False and tool.annotations.read_only_hint
    assert "contacts" in json.loads(schema)["properties"] and "[[contacts]]" in example


def test_solve_encloses_what_is_known(call):
    data, words, is_error = call("solve", scene=SCENE, degree=2)
    assert not is_error and data["status"] == "agree" and words.startswith(data["verdict"])
    # Half the work of the load on its own displacement, 1/E.
    energy = data["energy"]
    assert energy["lower"] <= -0.25 + 1e-14 and energy["upper"] >= -0.25 - 1e-14 and energy["gap"] < 1e-12
    (pull,) = data["quantities"]
    assert pull["lower"] <= 0.5 + 1e-14 and pull["upper"] >= 0.5 - 1e-14 and "pull (displacement)" in words


def test_verify_has_both_models(call):
    data, _, is_error = call("verify", scene=SCENE)
    assert not is_error and data["status"] == "agree" and data["passed_checks"] > 5 and data["failed_checks"] == []
    assert [model["name"] for model in data["primal"]] == ["FEniCSx P1", "FEniCSx P2"]
    assert all(abs(model["energy"] + 0.25) < 1e-12 for model in data["primal"])


@pytest.mark.parametrize("given", [{"file": "field.vtk"}, ARRAYS | {"displacement": exact()}])
def test_certify_takes_files_and_arrays(call, given):
    data, _, is_error = call("certify", scene=SCENE, solution=True, values={"pull": 0.5}, **given)
    assert not is_error and data["status"] == "agree" and data["primal"][0]["relative_error_bound"] < 1e-6


def test_certify_finds_a_wrong_value(call):
    data, words, is_error = call("certify", scene=SCENE, values={"pull": 0.6})
    assert not is_error and data["status"] == "disagree"
    assert [check["name"] for check in data["failed_checks"]] == ["quantity/pull/given"] and "0.6" in words


def test_diagnose_names_the_mistake(call):
    data, words, _ = call("diagnose", scene=SCENE, **ARRAYS, displacement=exact(poisson=0.3))
    assert data["status"] == "disagree" and "Poisson's ratio" in data["diagnosis"][0]["sentence"] and "Poisson's ratio" in words
    assert call("diagnose", scene=SCENE, **ARRAYS, displacement=exact())[0]["status"] == "agree"


def test_element_knows_its_own_and_judges_others(call):
    data, _, _ = call("element")
    names = [element["name"] for element in data["elements"]]
    assert call("element", name=names[0])[0]["status"] == "agree"
    # A single triangle with the stiffness of a spring at each node holds no rigid motion.
    identity = [[float(i == j) for j in range(6)] for i in range(6)]
    data, words, is_error = call("element", matrix=identity, nodes=[[0, 0], [1, 0], [0, 1]])
    assert not is_error and data["status"] == "disagree" and data["verdict"] in words
    assert any(finding["name"] == "rigid-motions" and finding["passed"] is False for finding in data["findings"])


@pytest.mark.parametrize(
    ("tool", "arguments", "fragment"),
    [
        ("solve", {}, "missing field `scene`"),
        ("solve", {"scene": 7}, "invalid type"),
        ("solve", {"scene": SCENE, "shell": "rm"}, "unknown field `shell`"),
        ("solve", {"scene": SCENE, "degree": 99}, "degree is 99"),
        ("solve", {"scene": SCENE, "refine": 13}, "refine is 13"),
        ("solve", {"scene": SCENE, "tolerance": -1}, "not above zero"),
        ("solve", {"scene": SCENE, "tolerance_of": {"no": 0.1}}, "no quantity 'no'"),
        ("solve", {"scene": "garbage ["}, "scene.toml"),
        ("solve", {"scene": SCENE.replace("0.25", "0.5")}, "poisson"),
        ("solve", {"scene": SCENE.replace("plate.msh", "../outside.msh")}, "folder of this server"),
        ("verify", {"scene": SCENE, "primal_degree": [0]}, "primal_degree"),
        ("certify", {"scene": SCENE}, "one thing has to be certified"),
        ("certify", {"scene": SCENE, "values": {"tip": 1}, "solution": True}, "only values are certified"),
        ("certify", {"scene": SCENE, "values": {"tip": 1}, "field": "zz"}, "there is none"),
        ("certify", {"scene": SCENE, "file": "/etc/passwd"}, "folder of this server"),
        ("certify", {"scene": SCENE, "file": "field.vtk", "values": {"no": 1}}, "no quantity 'no'"),
        ("diagnose", {"scene": SCENE, **ARRAYS}, "give all three"),
        ("diagnose", {"scene": SCENE, **ARRAYS, "displacement": [[0, 0]]}, "displacement"),
        ("diagnose", {"scene": SCENE, "points": [[0, 0]], "triangles": [[0, 1, 99]], "displacement": [[0, 0]]}, "beyond the 1"),
        ("element", {"name": "no-such"}, "there is no element"),
        ("element", {"matrix": [[1], [1, 2]], "nodes": [[0, 0]]}, "row 1"),
        ("element", {"nodes": [[0, 0]]}, "there is none"),
        ("element", {"young": 1}, "there is none"),
        ("element", {"matrix": [[1]], "nodes": [[0, 0]], "thickness": 2}, "give all three"),
        ("element", {"matrix": [], "nodes": []}, "nodes"),
    ],
)  # fmt: skip
def test_what_cannot_be_answered_says_why(call, tool, arguments, fragment):
    data, words, is_error = call(tool, **arguments)
    assert is_error and data["status"] in ("refused", "failed") and fragment in words and "panicked" not in words


def test_a_scene_without_equilibrium_is_an_answer(call):
    loose = SCENE.replace('{ on = "left", type = "roller" }, ', "")
    data, words, is_error = call("solve", scene=loose)
    assert not is_error and data["status"] == "infeasible" and "plate" in words


def test_limits_hold_and_the_server_goes_on(session):
    async def work(client):
        late = await client.call_tool("solve", {"scene": SCENE, "refine": 7})
        return late, await client.call_tool("element", {})

    late, after = session(work, "--max-seconds", "0.5")
    assert late.is_error and "ended after 0.5 s" in late.content[0].text and not after.is_error
    large, _ = session(work, "--max-memory", "100M")
    assert large.is_error and "--max-memory" in large.content[0].text


def test_there_are_no_other_tools(session):
    async def work(client):
        with pytest.raises(MCPError) as caught:
            await client.call_tool("shell", {"command": "true"})
        return caught.value

    assert session(work).error.code == -32602
