"""Finds the textures in MTL files, the material libraries of OBJ files."""

import re

_LINE_END = re.compile(r"\r\n|\r|\n")
# Options before the name of a texture, and the number of their values; -o, -s and -t have 1 to 3.
_OPTION_VALUES = {
    **dict.fromkeys(("-blendu", "-blendv", "-bm", "-boost", "-cc", "-clamp", "-imfchan"), 1),
    **dict.fromkeys(("-texres", "-type", "-colorspace"), 1),
    "-mm": 2,
    **dict.fromkeys(("-o", "-s", "-t"), 3),
}
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?", re.ASCII)


def parse_textures(text: str) -> dict[str, str]:
    """File names of the color textures (map_Kd) by the names of their materials; the first of each counts."""
    textures: dict[str, str] = {}
    material = ""
    for line in _LINE_END.split(text):
        words = line.split(maxsplit=1)
        if len(words) < 2 or words[0].startswith("#"):
            continue
        value = words[1].split(" #", 1)[0].strip()
        match words[0].lower():
            case "newmtl":
                material = value
            case "map_kd" if name := _without_options(value):
                textures.setdefault(material, name)
    return textures


def _without_options(value: str) -> str:
    """The file name after the options of a texture, without quotes; it may hold spaces."""
    while parts := value.split(maxsplit=1):
        count = _OPTION_VALUES.get(parts[0].lower())
        if count is None:
            break
        if count == 3:
            following = value.split()[1:4]
            count = next((k for k, word in enumerate(following) if not _NUMBER.fullmatch(word)), 3)
        parts = value.split(maxsplit=1 + count)
        value = parts[1 + count] if len(parts) > 1 + count else ""
    return value.strip().strip('"')
