"""Names of methods with settings."""

import pytest

from akap_editor.deform.deformer import make_deformer, method_names
from akap_editor.deform.methods import PRESETS, default_settings, parse_method, preset_of
from akap_editor.errors import InputError


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("akap", ("akap", {})),
        (" arap:converge ", ("arap", {"converge": True})),
        ("akap:no-dirichlet,trajectory=linear", ("akap", {"dirichlet": False, "trajectory": "linear"})),
        ("akap:memory=1", ("akap", {"memory": 1.0})),
        ("akap:dirichlet=no, exact=yes", ("akap", {"dirichlet": False, "exact": True})),
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
        ("arap:speed=3", "method arap: expected settings among iterations, .*, got 'speed'"),
        ("arap:iterations=many", "method arap: expected a number for iterations, got 'many'"),
        ("arap:iterations=2.5", "method arap: expected a number for iterations, got '2.5'"),
        ("arap:iterations", "method arap: expected a number for iterations, got 'yes'"),
        ("arap:converge=maybe", "method arap: expected yes or no for converge, got 'maybe'"),
    ],
)
def test_bad_specs_are_refused(text, sentence):
    with pytest.raises(InputError, match=sentence):
        parse_method(text)


def test_every_method_has_a_variant_and_every_variant_works(shapes):
    assert {variant.method for variant in PRESETS} == set(method_names())
    for variant in PRESETS:
        assert parse_method(variant.spec) == (variant.method, variant.settings)
        make_deformer(variant.method, shapes.SHAPES["square"], **variant.settings)
        assert variant.settings.items().isdisjoint(default_settings(variant.method).items())


def test_variants_are_told_by_their_settings():
    for variant in PRESETS:
        assert preset_of(variant.method, {**variant.settings, "irrelevant": 3}) is variant
    assert preset_of("akap", {"dirichlet": False, "trajectory": "linear", "memory": 1.0}).short == (
        "AKAP, straight, one solve"
    )
    assert preset_of("akap", {"dirichlet": True}).spec == "akap"
