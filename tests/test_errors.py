"""Messages of errors about files and their parts."""

import pytest

from akap_editor.errors import FileError, InputError, error_context, file_errors


@pytest.mark.parametrize(
    ("reason", "sentence"),
    [
        ("permission denied", "Permission denied."),
        ("read-only file system", "Read-only file system."),
        ("expected a mesh with faces, got none", "Expected a mesh with faces, got none."),
        ("line 5: expected numbers", "Line 5: expected numbers."),
        ("crop: expected one of none, frame, pose", "crop: expected one of none, frame, pose."),
        ("poses.json: expected names", "poses.json: expected names."),
        ("Couldn't open “a.png”. There is no such file.", "Couldn't open “a.png”. There is no such file."),
        ("", "."),
    ],
)
def test_a_file_error_names_the_file_and_gives_the_reason_as_a_sentence(reason, sentence):
    assert str(FileError("open", "cat.akap", reason)) == f"Couldn't open “cat.akap”. {sentence}"


def test_contexts_put_entry_and_file_before_the_message():
    with pytest.raises(FileError) as caught, file_errors("open", "cat.akap"), error_context("poses.json"):
        raise InputError("expected names of poses")
    assert str(caught.value) == "Couldn't open “cat.akap”. poses.json: expected names of poses."


def test_contexts_change_no_other_errors():
    with pytest.raises(KeyError, match="x"), file_errors("open", "cat.akap"), error_context("poses.json"):
        raise KeyError("x")


@pytest.mark.parametrize("character", ["a", "\n", "\udcff", "猫"])
def test_a_message_about_a_file_with_a_long_name_is_of_bounded_length(character):
    message = str(FileError("open", f"/folder/{character * 5000}.png", "there is no such file"))
    assert len(message) < 400
    assert message.startswith("Couldn't open “/folder/")
    assert message.endswith(".png”. There is no such file.")
