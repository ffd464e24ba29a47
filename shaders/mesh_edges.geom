#version 330 core
// Widens each edge to a ribbon, because core profiles draw lines one pixel wide and jagged.

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

uniform vec2 viewport;  // framebuffer pixels

const float REACH = 2.0;  // pixels from the middle of the line to the rim of its halo

out float offset;  // signed distance from the line in pixels
flat out float strength;

void main() {
    vec2 start = gl_in[0].gl_Position.xy, end = gl_in[1].gl_Position.xy;
    vec2 along = (end - start) * 0.5 * viewport;
    float span = length(along);
    if (span < 1e-3) return;
    // Short edges fade, so that a dense mesh does not cover a picture that is zoomed out.
    strength = clamp(span / 14.0, 0.12, 1.0);
    vec2 across = vec2(-along.y, along.x) / span * REACH * 2.0 / viewport;
    for (int corner = 0; corner < 4; ++corner) {
        float side = (corner & 1) == 0 ? -1.0 : 1.0;
        offset = side * REACH;
        gl_Position = vec4((corner < 2 ? start : end) + side * across, 0.0, 1.0);
        EmitVertex();
    }
}
