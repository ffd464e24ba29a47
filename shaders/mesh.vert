#version 330 core
// The textured mesh: drawing units to clip space.

uniform vec4 view;  // sx, sy, tx, ty: ndc = s * position + t

in vec2 in_position;  // drawing units
in vec2 in_uv;        // (0, 0) at the picture's top left corner

out vec2 uv;

void main() {
    uv = in_uv;
    gl_Position = vec4(in_position * view.xy + view.zw, 0.0, 1.0);
}
