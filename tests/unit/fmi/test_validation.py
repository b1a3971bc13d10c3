"""Validation of FMUs says what fmpy's says, though it leaves plain names to no parser."""

import zipfile
from types import SimpleNamespace

import pytest
from fmpy.model_description import ModelDescription
from fmpy.validation import _validate_variable_names, validate_fmu

from herringbone.fmi import validation
from herringbone.fmi.validation import is_plain, validation_problems

PLAIN = (
    "x", "_x1", "a.b_2.c", "x[1]", "x[1,20].y[3]", "der(x)", "der(a.b[2],2)", "der", "derx.der",
)  # fmt: skip
QUOTED = ("'a b'", "a.'x+y'.c", "der('q')")
ILLEGAL = (
    "", "1x", "a..b", ".a", "a.", "x[]", "x[1", "x[a]", "x[1].", "der(x", "der()", "der(x,)",
    "der(x,y)", "der(der(x))", "a b", "x\n", "é", "x-y", "''", "x[1][2]",
)  # fmt: skip


def is_legal(name):
    """By fmpy's grammar."""
    variables = [SimpleNamespace(name=name, sourceline=1)]
    described = SimpleNamespace(variableNamingConvention="structured", modelVariables=variables)
    return not _validate_variable_names(described)


@pytest.mark.parametrize("name", (*PLAIN, *QUOTED, *ILLEGAL))
def test_plain_names_are_legal_by_the_grammar(name):
    assert is_plain(name) == (name in PLAIN)
    assert is_legal(name) == (name not in ILLEGAL)


def edited(file, folder, old, new, more=""):
    """A copy with another text in its description, and one more file."""
    copy = folder / "edited.fmu"
    with zipfile.ZipFile(file) as source, zipfile.ZipFile(copy, "w") as target:
        for item in source.infolist():
            content = source.read(item)
            if item.filename == "modelDescription.xml":
                assert old in content
                content = content.replace(old, new)
            target.writestr(item, content)
        if more:
            target.writestr(more, "")
    return copy


@pytest.mark.parametrize(
    ("old", "new", "more"),
    [
        (b'name="torque"', b'name="torque"', ""),
        (b'name="torque"', b'name="tor que"', ""),
        (b'name="torque"', b'name="stiffness"', ""),
        (b'variability="continuous"', b'variability="never"', ""),
        (b"<ModelVariables>", b"<ModelVariable>", ""),
        (b'name="torque"', b'name="torque"', "resources\\x"),
    ],
    ids=["sound", "name", "twice", "schema", "xml", "path"],
)
def test_problems_are_those_of_fmpy(python_fmus, tmp_path, old, new, more):
    file = edited(python_fmus["shaft_coupling"], tmp_path, old, new, more)
    found = validation_problems(file)
    assert found == validate_fmu(str(file))
    assert bool(found) == (old != new or bool(more))


def test_plain_names_are_not_parsed(python_fmus, monkeypatch):
    asked = []
    monkeypatch.setattr(
        validation,
        "read_model_description",
        lambda file, **how: asked.append(how) or ModelDescription(modelVariables=[]),
    )
    assert validation_problems(python_fmus["shaft_coupling"]) == []
    assert asked == [{"validate_model_structure": True}]
