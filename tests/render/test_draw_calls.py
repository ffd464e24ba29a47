"""Triangles drawn without Python's lock: the same pixels as with it."""

import ctypes
from ctypes.util import find_library

import moderngl
import numpy as np
import pytest

from akap_editor.render.draw_calls import draw_triangles, unlocked_draw_triangles
from akap_editor.render.renderer import Renderer

SIZE, VIEW = (64, 48), (2 / 64, -2 / 48, -1.0, 1.0)


def address_of(name):
    """The address of an OpenGL function in the context of the tests, which EGL made."""
    library = ctypes.CDLL(find_library("EGL"))
    library.eglGetProcAddress.restype = ctypes.c_void_p
    return library.eglGetProcAddress(name.encode())


@pytest.fixture
def picture_of(ctx, sheet, noise):
    """The pixels of a drawing whose faces are drawn in two parts by a function."""

    def render(draw):
        renderer = Renderer(ctx, draw_triangles=lambda mesh, _, count: halves(draw, mesh, count))
        drawing = sheet(noise)
        renderer.show(drawing, drawing.mesh.vertices)
        target = ctx.simple_framebuffer(SIZE)
        with ctx.scope(target):  # moderngl fails if a framebuffer is released while it is bound
            renderer.draw(target, SIZE, VIEW)
        pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        target.release()
        renderer.release()
        return pixels

    def halves(draw, mesh, count):
        draw(mesh, 0, count // 2)
        draw(mesh, count // 2, count - count // 2)

    return render


def test_a_mesh_has_the_same_pixels_without_the_lock(picture_of):
    unlocked = unlocked_draw_triangles(address_of)
    assert unlocked is not draw_triangles
    pixels = picture_of(unlocked)
    assert len(set(pixels.tolist())) > 100
    np.testing.assert_array_equal(pixels, picture_of(draw_triangles))


def test_triangles_without_indices(ctx):
    program = ctx.program(
        vertex_shader="""#version 330 core
            void main() { gl_Position = vec4(4 * (gl_VertexID & 1) - 1, 2 * (gl_VertexID & 2) - 1, 0, 1); }
        """,
        fragment_shader="#version 330 core\nout vec4 color; void main() { color = vec4(0, 1, 0, 1); }",
    )
    mesh, target = ctx.vertex_array(program, []), ctx.simple_framebuffer((4, 4))
    with ctx.scope(target, moderngl.NOTHING):
        target.clear(1.0, 0.0, 0.0)
        unlocked_draw_triangles(address_of)(mesh, 0, 3)
    assert np.frombuffer(target.read(components=3), np.uint8).reshape(-1, 3).tolist() == [[0, 255, 0]] * 16
    for item in (mesh, target, program):
        item.release()


def test_moderngl_draws_where_functions_are_not_found():
    assert unlocked_draw_triangles(lambda name: None) is draw_triangles
