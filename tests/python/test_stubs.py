"""The type stubs name what the module has, with the arguments that it takes."""

import ast
import inspect
import json
import subprocess
import sys
from pathlib import Path

STUBS = Path(__file__).resolve().parents[2] / "hypercircle.pyi"
TREE = ast.parse(STUBS.read_text())
# Python's own words for what any class may have.
SILENT = {"__doc__", "__module__", "__repr__", "__weakref__", "__dict__"}


def own(class_):
    return {name for name, value in vars(class_).items() if name not in SILENT and value is not None}


def arguments(function):
    """Names, kinds and defaults of a function in the stubs; what is a default of its own there is `...`."""
    a, required = function.args, inspect.Parameter.empty
    usual = [*a.posonlyargs, *a.args]
    defaults = [required] * (len(usual) - len(a.defaults)) + a.defaults
    kind = inspect.Parameter
    found = [(x.arg, kind.POSITIONAL_ONLY if x in a.posonlyargs else kind.POSITIONAL_OR_KEYWORD, d) for x, d in zip(usual, defaults)]
    found += [(x.arg, kind.KEYWORD_ONLY, required if d is None else d) for x, d in zip(a.kwonlyargs, a.kw_defaults)]
    found += [(a.kwarg.arg, kind.VAR_KEYWORD, required)] if a.kwarg else []
    value = lambda d: d if d is required else ast.literal_eval(d)
    return [(name, kind, value(default)) for name, kind, default in found if name not in ("self", "cls")]


def assert_same(stub, function):
    expected = arguments(stub)
    actual = [(p.name, p.kind, p.default) for p in inspect.signature(function).parameters.values() if p.name != "self"]
    assert [x[:2] for x in expected] == [x[:2] for x in actual], stub.name
    for (name, _, said), (_, _, default) in zip(expected, actual):
        assert said is ... and default is not inspect.Parameter.empty or said == default, f"{stub.name}: {name}"


def test_stubs_and_module_agree(hypercircle):
    public = {name for name in hypercircle.__all__}
    classes = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}
    functions = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}
    assert public == {*classes, *functions, "__version__"}
    for name, stub in functions.items():
        assert_same(stub, getattr(hypercircle, name))
        assert getattr(hypercircle, name).__doc__
    for name, stub in classes.items():
        class_ = getattr(hypercircle, name)
        assert class_.__doc__ and class_.__module__ == "hypercircle"
        if issubclass(class_, Exception):
            assert [base.__name__ for base in class_.__bases__] == [base.id for base in stub.bases] and class_.remedy == ""
            continue
        members = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
        assert own(class_) == set(members), name
        for member, node in members.items():
            found = getattr(class_, member)
            assert found.__doc__, f"{name}.{member}"
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
            assert is_property == inspect.isdatadescriptor(found), f"{name}.{member}"
            if not is_property and not member.startswith("__"):
                assert_same(node, found)


def test_types_come_with_the_package(hypercircle):
    folder = Path(hypercircle.__file__).parent
    assert (folder / "py.typed").exists() and (folder / "__init__.pyi").read_text() == STUBS.read_text()


def test_the_tables_of_the_stubs_have_keys_of_scenes(hypercircle):
    """Completion offers what a scene takes, and nothing else."""
    schema = json.loads(subprocess.run([Path(sys.executable).parent / "hypercircle", "schema", "scene"], capture_output=True, check=True).stdout)
    known = {"_Scene": schema} | {f"_{name}": table for name, table in schema["$defs"].items()}
    tables = [node for node in TREE.body if isinstance(node, ast.ClassDef) and [getattr(base, "id", "") for base in node.bases] == ["TypedDict"]]
    assert len(tables) > 10
    for table in tables:
        keys = {field.target.id for field in table.body}
        assert keys == set(known[table.name]["properties"]), table.name
