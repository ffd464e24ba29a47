#version 330 core
// The rectangle of the picture's frame, without a vertex buffer.

uniform vec4 view;  // sx, sy, tx, ty: ndc = s * position + t
uniform vec2 frame;  // width and height of the picture, drawing units

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(corner * frame * view.xy + view.zw, 0.0, 1.0);
}
