# SPDX-License-Identifier: Apache-2.0
"""The stubs have the arguments that the functions have: mypy's stubtest cannot see those of functions made in C++."""

import ast
import re
from pathlib import Path

import pytest

import kinfer
import kinfer._kinfer

TREE = ast.parse((Path(kinfer.__file__).parent / "_kinfer.pyi").read_text())


def functions():
    for node in TREE.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, getattr(kinfer, node.name), node
        if isinstance(node, ast.ClassDef) and hasattr(kinfer, node.name):
            for method in node.body:
                decorators = [d.id for d in method.decorator_list] if isinstance(method, ast.FunctionDef) else []
                if isinstance(method, ast.FunctionDef) and "property" not in decorators and method.name[0] != "_":
                    yield f"{node.name}.{method.name}", getattr(getattr(kinfer, node.name), method.name), method


@pytest.mark.parametrize("name, function, stub", list(functions()), ids=lambda value: value if isinstance(value, str) else "")
def test_arguments_agree(name, function, stub):
    signature = function.__doc__.splitlines()[0]
    inside = signature[signature.index("(") + 1 : signature.rindex(")")]
    found = re.findall(r"(?:^|, )(\*|\w+)(?=:|,|$)", inside)
    expected = [argument.arg for argument in stub.args.args]
    if stub.args.kwonlyargs:
        expected += ["*", *(argument.arg for argument in stub.args.kwonlyargs)]
    assert found == expected
    assert function.__doc__.count("\n") >= 1 and len(function.__doc__) > len(signature) + 10, "it is documented"


def test_everything_public_is_in_the_stubs():
    stubs = {node.name for node in TREE.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    assert {name for name in kinfer.__all__ if name != "__version__"} <= stubs
