"""The stub and the documentation state what is there."""

import ast
import inspect
import sys
from pathlib import Path

import pytest
import rustslam2d as rs

STUB = Path(rs.__file__).parent / "__init__.pyi"


def members(body):
    """The public names of a body of a class or a module, each with its definition."""
    nodes = [node for node in body if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
    return {node.name: node for node in nodes if not node.name.startswith("_")}


def public(thing):
    return {name for name in vars(thing) if not name.startswith("_")}


@pytest.fixture(scope="module")
def stub():
    return members(ast.parse(STUB.read_text("utf-8")).body)


def test_the_stub_names_all_that_is_there_and_nothing_else(stub):
    assert (STUB.parent / "py.typed").is_file()
    assert set(rs.__all__) == set(stub)
    for name, node in stub.items():
        if isinstance(node, ast.ClassDef):
            inside = members(node.body)
            assert public(getattr(rs, name)) == set(inside), name


def parameters(function):
    """Names and kinds of the parameters, without self."""
    signature = inspect.signature(function).parameters.values()
    return [(one.name, one.kind == one.KEYWORD_ONLY) for one in signature if one.name != "self"]


def stated(node):
    before = node.args.posonlyargs + node.args.args + [one for one in [node.args.vararg] if one]
    names = [(one.arg, False) for one in before if one.arg != "self"]
    return names + [(one.arg, True) for one in node.args.kwonlyargs]


def test_the_stub_has_the_signatures(stub):
    compared = 0
    for name, node in stub.items():
        thing = getattr(rs, name)
        if isinstance(node, ast.FunctionDef):
            assert parameters(thing) == stated(node), name
            compared += 1
            continue
        for method in (one for one in node.body if isinstance(one, ast.FunctionDef)):
            decorators = [ast.unparse(decorator) for decorator in method.decorator_list]
            if decorators == ["property"]:
                assert inspect.isdatadescriptor(getattr(thing, method.name)), f"{name}.{method.name}"
            elif method.name == "__init__":
                # Python 3.9 does not read the signature of a class.
                assert sys.version_info < (3, 10) or parameters(thing) == stated(method), name
            elif decorators in ([], ["staticmethod"]) and method.name != "__len__":
                assert parameters(getattr(thing, method.name)) == stated(method), f"{name}.{method.name}"
            compared += 1
    assert compared > 40


def test_all_is_documented():
    for name in rs.__all__:
        thing = getattr(rs, name)
        assert inspect.getdoc(thing), name
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for attribute in public(thing):
                assert inspect.getdoc(getattr(thing, attribute)), f"{name}.{attribute}"
