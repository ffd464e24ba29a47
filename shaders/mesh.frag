#version 330 core
// The textured mesh; the picture is premultiplied.

uniform sampler2D picture;
uniform float opacity;

in vec2 uv;

out vec4 color;

void main() {
    color = texture(picture, uv) * opacity;
}
