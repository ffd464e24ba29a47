"""Commands that ask for a file and use it."""

from akap_editor.app import file_commands
from akap_editor.io.images import write_png


def test_a_reference_picture_is_chosen_by_its_file(pinned, tmp_path, image):
    write_png(tmp_path / "behind.png", image)
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    pinned.type_name("Choose reference picture", str(tmp_path / "behind.png"))
    assert (pinned.state.view.reference.image == image).all()
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    (tmp_path / "broken.png").write_bytes(b"no picture")
    pinned.type_name("Choose reference picture", str(tmp_path / "broken.png"))
    assert "broken.png" in pinned.state.error
    assert (pinned.state.view.reference.image == image).all()
    pinned.state.error = ""
