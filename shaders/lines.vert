#version 330 core
// Mesh edges and line segments: drawing units to clip space.

uniform vec4 view;  // sx, sy, tx, ty: ndc = s * position + t

in vec2 in_position;  // drawing units

void main() {
    gl_Position = vec4(in_position * view.xy + view.zw, 0.0, 1.0);
}
