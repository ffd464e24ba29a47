"""The labels of the history in the user's language. Recordings hold them in English."""

import re
from functools import cache

from ..words import mark, tr

# Labels with a number or a name in them
_TEMPLATES = (
    mark("Remove {count} Pins"),
    mark("Drag {count} Pins"),
    mark("Nudge {count} Pins"),
    mark("Delete {count} Keyframes"),
    mark("Duplicate {count} Keyframes"),
    mark("Reverse {count} Keyframes"),
    mark("Move {count} Keyframes"),
    mark("Apply {name}"),
    mark("Rename {name}"),
)
_SINGLE = (  # made of a verb and a noun
    mark("Delete Keyframe"),
    mark("Duplicate Keyframe"),
    mark("Reverse Keyframe"),
    mark("Move Keyframe"),
)


def shown_label(label: str) -> str:
    """A label of the history, which is English, as it is shown."""
    found = tr(label)
    if found != label:
        return found
    for template in _TEMPLATES:
        match = _pattern(template).fullmatch(label)
        if match is not None:
            return tr(template, **match.groupdict())
    return label


@cache
def _pattern(template: str) -> re.Pattern[str]:
    """What matches the labels of a template, with a group for its field."""
    before, name, after = re.split(r"[{}]", template)
    values = r"\d+" if name == "count" else ".+"
    return re.compile(f"{re.escape(before)}(?P<{name}>{values}){re.escape(after)}")
