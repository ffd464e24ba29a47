"""Textures of MTL files, as other programs write them."""

import pytest

from akap_editor.io.mesh_files.materials import parse_textures


@pytest.mark.parametrize(
    ("text", "textures"),
    [
        ("newmtl skin\nmap_Kd skin.png\n", {"skin": "skin.png"}),
        ("newmtl a\r\nmap_Kd a.png\r\nnewmtl b\r\nmap_Kd b.png", {"a": "a.png", "b": "b.png"}),
        ("NEWMTL a\nMAP_KD a.png\n", {"a": "a.png"}),
        ("newmtl a\nmap_Kd first.png\nmap_Kd second.png\n", {"a": "first.png"}),
        ("newmtl a\nmap_Kd my picture.png # the skin\n", {"a": "my picture.png"}),
        ('newmtl a\nmap_Kd "my picture.png"\n', {"a": "my picture.png"}),
        ("newmtl a\nmap_Kd -clamp on textures/a.png\n", {"a": "textures/a.png"}),
        ("newmtl a\nmap_Kd -s 1 1 1 -o 0.5 -bm 2 my a.png\n", {"a": "my a.png"}),
        ("newmtl a\nmap_Kd -o .5 1e-3 a.png\n", {"a": "a.png"}),
        ("newmtl a\nmap_Kd -mm 0 1 a.png\n", {"a": "a.png"}),
        ("map_Kd nameless.png\n", {"": "nameless.png"}),
        ("newmtl a\nmap_Kd -clamp on\nmap_Kd\n# map_Kd no.png\nmap_Ks shine.png\n", {}),
        ("newmtl a\nmap_Kd -s\nmap_Kd -s 1 1\n", {}),
        ("", {}),
    ],
)
def test_the_color_texture_of_each_material_is_found(text, textures):
    assert parse_textures(text) == textures
