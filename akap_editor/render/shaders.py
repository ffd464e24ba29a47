"""Shader programs from the files of the folder ``shaders``."""

from typing import Any

import moderngl

from ..resources import resource

View = tuple[float, float, float, float]  # (sx, sy, tx, ty) with ndc = s * position + t, see `Camera.view`

_STAGES = {"vert": "vertex_shader", "geom": "geometry_shader", "frag": "fragment_shader"}


def load_program(ctx: moderngl.Context, *names: str) -> moderngl.Program:
    """Compile shader files; their endings vert, geom and frag tell the stage."""
    sources: dict[str, Any] = {
        _STAGES[name.rpartition(".")[2]]: resource("shaders", name).read_text("utf-8") for name in names
    }
    return ctx.program(**sources)
