"""Writes docs/shortcuts.md from the table of commands.

Run from the project's root: python tools/make_shortcuts.py
"""

from pathlib import Path

from akap_editor.app.commands.registry import COMMANDS, MENUS
from akap_editor.app.commands.shortcuts_page import groups

PAGE = Path("docs/shortcuts.md")
HEAD = """# Keyboard and mouse

`?` or `F1` shows these shortcuts in the program:

![The shortcuts page over the window](images/keys.png)

`Ctrl+K` or `F3` opens the command palette, which finds every command by a few letters of its name, with or
without a shortcut:

![The command palette after typing "sho"](images/palette.png)

`F10`, or `Alt` and its first letter, opens a menu; the arrow keys move through it, `Enter` chooses, `Esc`
closes. `F6` moves the keyboard focus from the drawing to the side panel, and on to toolbar, timeline,
second method, color scale, first steps, options bar, tabs, and back to the drawing; `Shift+F6` goes the other
way. In panels and dialogs, `Tab` and the arrow keys move between controls, `Enter` presses
one, `Shift+F10` opens its menu, and `Esc` returns the focus to the drawing. Pins can be placed
[without a mouse](posing.md#without-a-mouse), too.

`tools/make_shortcuts.py` writes this page.
"""


def page() -> str:
    """Return the page as Markdown."""
    parts = [HEAD]
    for title, lines in groups(MENUS, COMMANDS):
        rows = "".join(f"| {keys.replace('|', chr(92) + '|')} | {action} |\n" for keys, action in lines)
        parts.append(f"\n## {title}\n\n| | |\n|---|---|\n{rows}")
    return "".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
    print(PAGE)
