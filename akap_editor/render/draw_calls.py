"""Draws triangles, with or without Python's lock.

moderngl keeps the lock while OpenGL works. Some drivers do much in a call: Mesa's software renderer
transforms all vertices, and waits until pictures that it reads are drawn; others wait for the screen. The
thread that computes steps stands still meanwhile, so a window draws what takes long without the lock.
"""

import ctypes
from collections.abc import Callable
from typing import Any

import moderngl

AddressOf = Callable[[str], Any]  # from the name of an OpenGL function to its address; None if there is none
DrawTriangles = Callable[[moderngl.VertexArray, int, int], None]  # a mesh, the first corner, their number

_UNSIGNED_INT = 0x1405  # the type of the indices in all meshes


def draw_triangles(mesh: moderngl.VertexArray, first: int, count: int) -> None:
    """Draw ``count`` corners of a mesh from the corner ``first`` on."""
    mesh.render(moderngl.TRIANGLES, vertices=count, first=first)


def unlocked_draw_triangles(address_of: AddressOf) -> DrawTriangles:
    """`draw_triangles` that releases Python's lock in OpenGL; moderngl's if the functions are not found.

    address_of: for the current context, which other threads may not use meanwhile.
    """
    integer, size, pointer = ctypes.c_uint, ctypes.c_int, ctypes.c_void_p
    types = {
        "glUseProgram": (integer,),
        "glBindVertexArray": (integer,),
        "glDrawArrays": (integer, size, size),
        "glDrawElements": (integer, size, integer, pointer),
    }
    addresses = [address_of(name) for name in types]
    if not all(addresses):
        return draw_triangles
    use_program, bind, draw_arrays, draw_elements = (
        ctypes.CFUNCTYPE(None, *arguments)(address)
        for address, arguments in zip(addresses, types.values(), strict=True)
    )

    def draw(mesh: moderngl.VertexArray, first: int, count: int) -> None:
        use_program(mesh.program.glo)
        bind(mesh.glo)
        if mesh.index_buffer is None:
            draw_arrays(moderngl.TRIANGLES, first, count)
        else:
            draw_elements(moderngl.TRIANGLES, count, _UNSIGNED_INT, first * mesh.index_element_size)

    return draw
