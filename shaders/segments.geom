#version 330 core
// Widens each segment to a ribbon with smooth sides.

layout(lines) in;
layout(triangle_strip, max_vertices = 4) out;

uniform vec2 viewport;  // framebuffer pixels
uniform float width;    // framebuffer pixels

out float offset;  // signed distance from the middle of the line in pixels

void main() {
    vec2 start = gl_in[0].gl_Position.xy, end = gl_in[1].gl_Position.xy;
    vec2 along = (end - start) * 0.5 * viewport;
    float span = length(along);
    if (span < 1e-3) return;
    float reach = 0.5 * width + 1.0;
    vec2 across = vec2(-along.y, along.x) / span * reach * 2.0 / viewport;
    for (int corner = 0; corner < 4; ++corner) {
        float side = (corner & 1) == 0 ? -1.0 : 1.0;
        offset = side * reach;
        gl_Position = vec4((corner < 2 ? start : end) + side * across, 0.0, 1.0);
        EmitVertex();
    }
}
