"""The History section of the side panel."""

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.editor import Editor


def click(hand, label):
    hand.set_ref("Panel")
    hand.item_click(label)


def test_a_click_on_a_step_goes_there_and_back(pinned):
    pinned.unfold("Pose", "History")
    poses = [pinned.session.state]
    for pin, dy in ((3, -60), (3, 40), (1, 30)):
        start = pinned.to_screen(pinned.pin_position(pin))
        pinned.drag(start, (start[0], start[1] + dy))
        poses.append(pinned.session.state)
    pinned.state.notice = "Saved figure.akap"
    for index in (1, 0, 3, 2):
        name = "Drag Pin" if index else "Open"
        pinned.do(lambda hand, label=f"**/{name}##step {index}": click(hand, label))
        assert pinned.session.history.depth == index
        assert not pinned.state.notice, "it is about something else"
        assert pinned.session.state.positions.tobytes() == poses[index].positions.tobytes()
    assert pinned.session.history.labels == ["Drag Pin"] * 3


def test_there_is_no_going_beyond_the_ends(drawing):
    editor = Editor()
    editor.undo_or_redo_to(3)
    editor.open(new_document(drawing))
    gestures.add_pin(editor, (50.0, 80.0))
    for depth, expected in ((-2, 0), (9, 1)):
        editor.undo_or_redo_to(depth)
        assert editor.session.history.depth == expected
