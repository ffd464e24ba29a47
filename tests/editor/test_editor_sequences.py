"""Random sequences of events and edits: invariants hold, and all of it is undone, redone and replayed."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

from akap_editor.editor import gestures
from akap_editor.editor.document.document import new_document
from akap_editor.editor.events import KeyEvent, PointerEvent
from akap_editor.editor.session.edits import EDITS
from akap_editor.editor.session.stepper import INLINE
from akap_editor.errors import InputError
from tests.support.edit_examples import EDIT_EXAMPLES
from tests.support.editor_driver import OUTSIDE, Driver, bits, replayed_state

HEAD, NECK, END = (20.0, 40.0), (62.0, 40.0), (105.0, 40.0)

places = st.one_of(
    st.sampled_from([HEAD, NECK, END, (45.0, 25.0), (45.0, 55.0), OUTSIDE, (118.0, 78.0)]),
    st.tuples(st.floats(-20, 140), st.floats(-20, 100)),
)
buttons = st.sampled_from(["left", "left", "left", "middle", "right"])


def random_editing(drawing, worker):
    """A state machine that edits a drawing in an editor with this executor for steps."""

    class RandomEditing(RuleBasedStateMachine):
        """Random events and edits; the driver checks its invariants after each one."""

        @initialize()
        def begin(self):
            self.driver = Driver(new_document(drawing), worker=worker)
            self.editor = self.driver.editor
            self.first = bits(self.driver.state)
            self.driver.click(HEAD)
            self.driver.click(END)

        @rule(at=places, button=buttons, shift=st.booleans())
        def press(self, at, button, shift):
            self.driver.press(at, button, shift)

        @rule(at=places, steps=st.integers(0, 3))
        def move(self, at, steps):
            self.driver.move(at)
            for _ in range(steps):
                self.driver.advance()

        @rule(at=places, button=buttons)
        def release(self, at, button):
            self.driver.release(at, button)

        @rule(at=places, shift=st.booleans())
        def click(self, at, shift):
            self.driver.click(at, shift)

        @rule(key=st.sampled_from(["left", "up", "right", "down"]), shift=st.booleans())
        def nudge(self, key, shift):
            self.driver.handle(KeyEvent(key, shift=shift))

        @rule(clicks=st.integers(0, 2), forward=st.booleans())
        def point_by_keys(self, clicks, forward):
            self.editor.toggle_keyboard_pointer()
            for _ in range(clicks):
                self.driver.key("enter")
                self.editor.select_next(forward)
                self.driver.check()

        @rule(at=places)
        def alt_click(self, at):
            for kind in ("press", "release"):
                self.driver.handle(PointerEvent(kind, self.editor.camera.to_screen(at), alt=True))

        @rule(pin=st.integers(0, 5), to=places, shift=st.booleans())
        def start_drag(self, pin, to, shift):
            self.driver.key("escape")
            if self.driver.ids:
                self.driver.press(self.driver.where(self.driver.ids[pin % len(self.driver.ids)]), shift=shift)
                self.driver.move(to)
                self.driver.advance()

        @rule(complete=st.booleans())
        def end_gesture(self, complete):
            if complete:
                self.driver.release(NECK)
            else:
                self.driver.key("escape")

        @rule(count=st.integers(1, 20))
        def advance(self, count):
            for _ in range(count):
                self.driver.advance()

        @rule(at=places, amount=st.integers(-3, 3))
        def zoom_and_pan(self, at, amount):
            self.driver.scroll(at, amount)
            self.driver.drag(at, NECK, steps=1, button="middle")

        @rule(back=st.booleans())
        def undo_or_redo(self, back):
            if back:
                self.driver.undo()
            else:
                self.driver.redo()

        @rule(all_pins=st.booleans())
        def remove_selected(self, all_pins):
            if all_pins:
                self.editor.select_all()
            gestures.remove_selected_pins(self.editor)
            self.driver.check()

        @rule(memory=st.sampled_from([0.0, 1.0]))
        def change_memory(self, memory):
            settings = self.driver.state.settings.with_parameter("memory", memory)
            gestures.set_settings(self.editor, settings)
            self.driver.check()

        @rule(names=st.permutations(list(EDITS)), count=st.integers(1, 8))
        def apply_edits(self, names, count):
            self.driver.key("escape")
            for name in names[:count]:
                depth = self.driver.depth
                try:
                    self.editor.apply("Edit", EDIT_EXAMPLES[name](self.driver.session))
                except InputError:
                    assert self.driver.depth == depth
                self.driver.check()

        def teardown(self):
            self.editor.cancel()
            if self.driver.session.has_pending_step:
                self.driver.session.step()
            assert bits(replayed_state(self.driver.session.recording, drawing)) == bits(self.driver.state)
            states = [bits(self.driver.state)]
            while self.driver.depth:
                self.driver.undo()
                states.append(bits(self.driver.state))
            assert states[-1] == self.first
            for state in reversed(states[:-1]):
                self.driver.redo()
                assert bits(self.driver.state) == state

    return RandomEditing


@pytest.mark.parametrize("in_thread", [False, True], ids=["at once", "in a thread"])
def test_whatever_is_done_can_be_undone_and_redone_and_replayed(drawing, in_thread):
    with ThreadPoolExecutor(1) as thread:
        machine = random_editing(drawing, thread if in_thread else INLINE)
        run_state_machine_as_test(machine, settings=settings(max_examples=20, stateful_step_count=30))
