"""Writes docs/shortcuts.md from the program's own table of commands.

Run from the project's root: python tools/make_shortcuts.py
"""

from pathlib import Path

from akap_editor.app.commands.shortcuts_page import groups

PAGE = Path("docs/shortcuts.md")
HEAD = """# Keys and mouse

`?` or `F1` shows these keys in the program:

![The page of keys over the window](images/keys.png)

`Ctrl+K` or `F3` finds every command by a few of its letters, also those without a key:

![The command palette with the letters "sho" typed](images/palette.png)

Menus open with `F10`, or `Alt` and their first letter; arrows walk through them, `Enter` takes a line, `Esc`
leaves. `Tab` goes from the drawing to the side panel, `Shift+Tab` to the tools, `F6` from one panel to the
next: side panel, tools, timeline, second method, scale of colors, first steps, and back to the drawing. There
and in dialogs, `Tab` and the arrows move from one thing to the next, `Enter` uses it, `Shift+F10` opens its
menu, `Esc` gives the keys back to the drawing. Pins are set [without a mouse](posing.md#without-a-mouse).

This page is written by `tools/make_shortcuts.py`.
"""


def page() -> str:
    """The whole page."""
    parts = [HEAD]
    for title, lines in groups():
        rows = "".join(f"| {keys.replace('|', chr(92) + '|')} | {what} |\n" for keys, what in lines)
        parts.append(f"\n## {title}\n\n| | |\n|---|---|\n{rows}")
    return "".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
    print(PAGE)
