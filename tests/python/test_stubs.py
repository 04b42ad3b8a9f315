# SPDX-License-Identifier: Apache-2.0
"""The stubs name what the module has, with the same arguments, and everything is documented."""

import ast
import inspect
import pathlib
import re

import pytest

import softgauss

SPECIAL = ("__len__", "__getitem__", "__delitem__")
STUBS = ast.parse((pathlib.Path(softgauss.__file__).parent / "softgauss.pyi").read_text())
CLASSES = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
NATIVE = [
    name
    for name, thing in vars(softgauss).items()
    if inspect.isclass(thing) and not name.startswith("_")
]


def members(name):
    """Public members of a stub's class: functions, properties, attributes."""
    named = {}
    for node in CLASSES[name].body:
        if isinstance(node, ast.FunctionDef):
            named[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            named[node.target.id] = node
    return named


def test_classes_are_the_same():
    assert set(CLASSES) == set(NATIVE)
    assert {"Env", "VectorEnv", "Box"} <= set(dir(softgauss))


@pytest.mark.parametrize("name", NATIVE)
def test_members_are_the_same(name):
    own = {
        member
        for member in vars(getattr(softgauss, name))
        if not member.startswith("_") or member in SPECIAL
    }
    stubs = {member for member in members(name) if member != "__init__"}
    assert own == stubs


@pytest.mark.parametrize("name", NATIVE)
def test_arguments_are_the_same(name):
    for member, node in members(name).items():
        native = getattr(softgauss, name).__dict__.get(member)
        isproperty = isinstance(node, ast.AnnAssign) or node.decorator_list
        if isproperty or member in SPECIAL:
            continue
        signature = re.match(r"\w+\((.*)\) ->", native.__doc__, re.S).group(1)
        own = [arg for arg in re.findall(r"(\w+): ", signature) if arg not in ("self", "kwargs")]
        stub = [a.arg for a in node.args.args if a.arg != "self"]
        # Of what goes on to other options the stubs name some.
        stub += [a.arg for a in node.args.kwonlyargs if "**kwargs" not in signature or a.arg in own]
        assert own == stub, (name, member, native.__doc__)


@pytest.mark.parametrize(
    "name", [n for n in NATIVE if not issubclass(getattr(softgauss, n), Exception)]
)
def test_everything_is_documented(name):
    bare = [
        member
        for member in members(name)
        if member not in SPECIAL
        and not (vars(getattr(softgauss, name))[member].__doc__ or "").strip()
    ]
    assert getattr(softgauss, name).__doc__ and not bare
