"""The table of methods: names, presets, parameters, and the notation for both."""

import inspect

import numpy as np
import pytest

from akap_editor.deform.deformer import Deformer
from akap_editor.deform.methods import (
    METHODS,
    Choice,
    NumberRange,
    Switch,
    compared_methods,
    default_parameters,
    get_method,
    make_deformer,
    method_names,
    nearest_preset,
    parse_method,
    presets,
    presets_of,
)
from akap_editor.errors import InputError
from tests.support import shapes
from tests.support.toy_method import TOY, TranslationDeformer, add_toy_method


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("akap", ("akap", {})),
        (" arap:converge ", ("arap", {"converge": True})),
        ("akap:no-dirichlet,trajectory=linear", ("akap", {"dirichlet": False, "trajectory": "linear"})),
        ("akap:memory=1", ("akap", {"memory": 1.0})),
        ("akap:dirichlet=no, exact=yes", ("akap", {"dirichlet": False, "exact": True})),
        ("akap:max_step=0.1", ("akap", {"max_step": 0.1})),  # by default None
        ("cauchy-green:cage=40,smoothness=1e-3", ("cauchy-green", {"cage": 40, "smoothness": 1e-3})),
    ],
)
def test_specs_are_read(text, expected):
    found = parse_method(text)
    assert found == expected
    assert [type(value) for value in found[1].values()] == [type(value) for value in expected[1].values()]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("magic", "method: expected one of akap, .*, got 'magic'"),
        ("", "method: expected one of akap, .*, got ''"),
        ("arap:speed=3", "method arap: expected parameters among iterations, .*, got 'speed'"),
        ("arap:iterations=many", "method arap: expected a number for iterations, got 'many'"),
        ("arap:iterations=2.5", "method arap: expected a number for iterations, got '2.5'"),
        ("arap:iterations", "method arap: expected a number for iterations, got 'yes'"),
        ("akap:max_step=long", "method akap: expected a number for max_step, got 'long'"),
        ("arap:converge=maybe", "method arap: expected yes or no for converge, got 'maybe'"),
    ],
)
def test_bad_specs_are_refused(text, sentence):
    with pytest.raises(InputError, match=sentence):
        parse_method(text)


def test_every_method_has_a_preset_and_every_preset_works():
    assert {preset.method for preset in presets()} == set(method_names())
    for preset in presets():
        assert parse_method(preset.spec) == (preset.method, preset.parameters)
        make_deformer(preset.method, shapes.SHAPES["square"], **preset.parameters)
        assert preset.parameters.items().isdisjoint(default_parameters(preset.method).items())
        assert preset.label
        assert preset.short


@pytest.mark.parametrize("preset", [preset for method in METHODS.values() for preset in method.presets])
def test_presets_of_the_table_are_described(preset):
    assert preset.note.endswith(".")
    assert preset.description == f"{preset.note} {preset.source}."


@pytest.mark.parametrize("method", method_names())
def test_first_preset_of_a_method_is_the_plain_one(method):
    assert presets_of(method)[0].spec == method


def test_labels_of_presets_differ():
    assert len({preset.label for preset in presets()}) == len({preset.short for preset in presets()})
    assert len({preset.label for preset in presets()}) == len(presets())


def test_presets_are_told_by_their_parameters():
    for preset in presets():
        assert nearest_preset(preset.method, {**preset.parameters, "irrelevant": 3}) == preset
    assert nearest_preset("akap", {"dirichlet": False, "trajectory": "linear", "memory": 1.0}).short == (
        "AKAP, straight, one solve"
    )
    assert nearest_preset("akap", {"dirichlet": True}).spec == "akap"


def test_comparisons_run_every_method():
    assert {parse_method(spec)[0] for spec in compared_methods()} == set(method_names())
    assert "akap" in compared_methods()
    assert "akap:memory=1" in compared_methods()


@pytest.mark.parametrize("method", method_names())
def test_every_parameter_of_every_method_is_described(method):
    described, defaults = get_method(method).parameters, default_parameters(method)
    painted = {"stiffness"}  # has a brush instead of a field in the panel
    assert sorted(parameter.name for parameter in described) == sorted(set(defaults) - painted)
    for parameter in described:
        assert parameter.label
        assert parameter.tooltip.endswith(".")


@pytest.mark.parametrize("method", method_names())
def test_defaults_lie_in_the_ranges_of_the_table(method):
    defaults = {**default_parameters(method), **get_method(method).document_defaults}
    for parameter in get_method(method).parameters:
        value = defaults[parameter.name]
        match parameter.kind:
            case Switch():
                assert isinstance(value, bool)
            case Choice(labels):
                assert value in labels
            case NumberRange(low, high, is_whole=is_whole):
                assert value is None or low <= value <= high
                assert isinstance(value, int) == is_whole


@pytest.mark.parametrize("method", method_names())
def test_every_value_of_the_table_is_accepted(method):
    for parameter in get_method(method).parameters:
        match parameter.kind:
            case Switch():
                values = [False, True]
            case Choice(labels):
                values = list(labels)
            case NumberRange(low, high, is_whole=is_whole):
                values = [int(low), int(high)] if is_whole else [low, high]
        for value in values:
            make_deformer(method, shapes.SHAPES["square"], **{parameter.name: value})
    make_deformer(method, shapes.SHAPES["square"], **get_method(method).document_defaults)


@pytest.mark.parametrize("method", method_names())
def test_capabilities_are_those_of_the_class(method):
    deformer = get_method(method).deformer
    assert deformer.holds_angles == ("angles" in inspect.signature(deformer.step).parameters)
    assert deformer.takes_stiffness == ("stiffness" in default_parameters(method))
    assert deformer.has_memory == ("memory" in default_parameters(method))
    assert deformer.takes_joints == ("joints" in inspect.signature(deformer).parameters)
    assert deformer.has_vector_fields == hasattr(deformer, "vector_fields")


def test_unknown_method_is_refused_with_the_known_ones():
    names = ", ".join(method_names())
    with pytest.raises(InputError, match=f"method: expected one of {names}, got 'magic'"):
        make_deformer("magic", shapes.SHAPES["triangle"])


def test_unknown_parameter_is_refused_with_the_known_ones():
    for method in method_names():
        known = "parameters among .*" if default_parameters(method) else "no parameters"
        with pytest.raises(InputError, match=f"method {method}: expected {known}, got 'speed'"):
            make_deformer(method, shapes.SHAPES["triangle"], speed=3)


@pytest.mark.parametrize("name", [None, 3, ["akap"]])
def test_method_that_is_no_name_is_refused(name):
    with pytest.raises(InputError, match="method: expected one of "):
        make_deformer(name, shapes.SHAPES["triangle"])


def test_tied_islands_move_under_every_method_that_the_table_gets(monkeypatch):
    add_toy_method(monkeypatch)
    for method in METHODS:
        deformer: Deformer = make_deformer(method, shapes.SHAPES["islands"])
        assert deformer.has_vector_fields == get_method(method).deformer.has_vector_fields


def test_a_method_without_presets_and_parameters_works_everywhere_in_the_table(monkeypatch):
    add_toy_method(monkeypatch)
    mesh = shapes.SHAPES["square"]
    assert method_names()[-1] == TOY
    assert parse_method(TOY) == (TOY, {})
    assert default_parameters(TOY) == {}
    assert presets()[-1] == presets_of(TOY)[0] == nearest_preset(TOY, {})
    assert (presets()[-1].spec, presets()[-1].label, presets()[-1].short) == (TOY, TOY, TOY)
    assert nearest_preset(TOY, {"left over": 1}).spec == TOY
    assert presets()[-1].description == ""
    assert compared_methods()[-1] == TOY
    for refused in (lambda: parse_method("toy:speed=3"), lambda: make_deformer(TOY, mesh, speed=3)):
        with pytest.raises(InputError, match="method toy: expected no parameters, got 'speed'"):
            refused()
    deformer = make_deformer(TOY, mesh)
    assert isinstance(deformer, TranslationDeformer)
    deformer.set_pins(mesh.locate(mesh.vertices[:1]))
    moved = deformer.step(mesh.vertices, mesh.vertices[:1] + 2.0).positions
    assert np.abs(moved - mesh.vertices - 2.0).max() < 1e-12
