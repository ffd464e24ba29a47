"""Settings: parameters with defaults, equal whatever the order of changes."""

import pytest

from akap_editor.editor.document.settings import Settings
from akap_editor.errors import InputError


def test_settings_with_a_parameter_changed_or_added():
    settings = Settings()
    changed = settings.with_parameter("memory", 0.25)
    assert changed.get("memory") == 0.25
    assert settings.get("memory") == 1.0
    assert changed.with_parameter("memory", 1.0) == settings
    assert settings.get("dirichlet", "left to the method") == "left to the method"


def test_settings_are_equal_whatever_the_order_of_changes():
    one = Settings().with_parameter("pin_weight", 10.0).with_parameter("dirichlet", False)
    other = Settings().with_parameter("dirichlet", False).with_parameter("pin_weight", 10.0)
    assert one == other


def test_a_spec_changes_the_defaults_of_the_editor():
    assert Settings.parse("akap") == Settings()
    assert Settings.parse("akap:no-dirichlet") == Settings().with_parameter("dirichlet", False)
    assert Settings.parse("arap") == Settings("arap", ())
    with pytest.raises(InputError, match="no such"):
        Settings.parse("no such")


def test_json_there_and_back():
    settings = Settings().with_parameter("dirichlet", False)
    assert Settings.from_json(settings.to_json()) == settings
    record = {"method": "akap", "parameters": {"memory": 1.0, "dirichlet": False}}
    assert Settings.from_json(record) == settings
